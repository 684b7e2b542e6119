/* The corners and volumes of a leaf's eight triangles, for kernels. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "src/core/simd_lanes.h"

/* Indexed by corner, end of the interval and axis, with a lane per triangle. */
typedef f32x8 leaf_corners[3][2][3];

static inline void load_corners(const bvh *hierarchy, const bvh_leaf *l, leaf_corners out) {
    for (int i = 0; i < 3; i++) {
        f32x8 rows[8];
        for (int lane = 0; lane < LANES; lane++)
            rows[lane] = f32x8_load(hierarchy->records[l->corners[i][lane]]);
        f32x8_transpose(rows);
        for (int k = 0; k < 3; k++) {
            out[i][0][k] = rows[k];
            out[i][1][k] = rows[4 + k];
        }
    }
}

/* Volumes of the triangles: at the start and at the end along x, y, z, x+y+z, x+y-z, x-y+z, -x+y+z; over the
 * interval, low and high, along x, y, z. All of them are rounded outward. */
typedef struct leaf_volumes {
    f32x8 low[2][KDOP_AXES], high[2][KDOP_AXES], swept[BOX_AXES][2];
} leaf_volumes;

/* Computes the coordinates along the directions of kdop_axes that boxes do not have. */
static inline void diagonals_of(const f32x8 p[3], f32x8 out[KDOP_AXES - BOX_AXES]) {
    f32x8 sum = p[0] + p[1], difference = p[0] - p[1];
    out[0] = sum + p[2];
    out[1] = sum - p[2];
    out[2] = difference + p[2];
    out[3] = p[2] - difference;
}

static inline void enclose_corners(const f32x8 *a, const f32x8 *b, const f32x8 *c, int count, float slack,
                                   f32x8 *low, f32x8 *high) {
    for (int k = 0; k < count; k++) {
        low[k] = f32x8_min(f32x8_min(a[k], b[k]), c[k]) - f32x8_all(slack);
        high[k] = f32x8_max(f32x8_max(a[k], b[k]), c[k]) + f32x8_all(slack);
    }
}

/* slack[0] is for axes, slack[1] for diagonals. still: both ends are the same moment, and only the start is written. */
static inline void volumes_of(leaf_corners corners, const float slack[2], bool still, leaf_volumes *v) {
    int last = still ? 0 : 1;
    for (int e = 0; e <= last; e++) {
        f32x8 diagonals[3][KDOP_AXES - BOX_AXES];
        for (int i = 0; i < 3; i++) diagonals_of(corners[i][e], diagonals[i]);
        enclose_corners(corners[0][e], corners[1][e], corners[2][e], BOX_AXES, slack[0], v->low[e],
                        v->high[e]);
        enclose_corners(diagonals[0], diagonals[1], diagonals[2], KDOP_AXES - BOX_AXES, slack[1],
                        v->low[e] + BOX_AXES, v->high[e] + BOX_AXES);
    }
    for (int k = 0; k < BOX_AXES; k++) {
        v->swept[k][0] = f32x8_min(v->low[0][k], v->low[last][k]);
        v->swept[k][1] = f32x8_max(v->high[0][k], v->high[last][k]);
    }
}
