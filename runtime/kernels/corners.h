/* The corners of a leaf's eight triangles, as kernels see them. */
#ifndef CSCD_CORNERS_H
#define CSCD_CORNERS_H

#include "runtime/forest.h"
#include "src/simd.h"

/* By corner, end of the interval and axis, a lane per triangle. */
typedef f32x8 leaf_corners[3][2][3];

static inline void load_corners(const forest *f, const forest_leaf *l, leaf_corners out) {
    for (int i = 0; i < 3; i++) {
        f32x8 rows[8];
        for (int lane = 0; lane < LANES; lane++) rows[lane] = f32x8_load(f->records[l->corners[i][lane]]);
        f32x8_transpose(rows);
        for (int k = 0; k < 3; k++) {
            out[i][0][k] = rows[k];
            out[i][1][k] = rows[4 + k];
        }
    }
}

/* Volumes of the triangles over the interval, along x, y, z, x+y+z, x+y-z, x-y+z, -x+y+z, not yet rounded
 * outward. */
typedef struct leaf_volumes {
    f32x8 low[KDOP_AXES], high[KDOP_AXES];
} leaf_volumes;

static inline void extend(leaf_volumes *v, int axis, f32x8 value) {
    v->low[axis] = f32x8_min(v->low[axis], value);
    v->high[axis] = f32x8_max(v->high[axis], value);
}

static inline void volumes_of(leaf_corners corners, int axis_count, leaf_volumes *v) {
    for (int k = 0; k < axis_count; k++) {
        v->low[k] = f32x8_all(__builtin_inff());
        v->high[k] = f32x8_all(-__builtin_inff());
    }
    for (int i = 0; i < 3; i++) {
        for (int e = 0; e < 2; e++) {
            const f32x8 *p = corners[i][e];
            for (int k = 0; k < 3; k++) extend(v, k, p[k]);
            if (axis_count == BOX_AXES) continue;
            f32x8 sum = p[0] + p[1], difference = p[0] - p[1];
            extend(v, 3, sum + p[2]);
            extend(v, 4, sum - p[2]);
            extend(v, 5, difference + p[2]);
            extend(v, 6, p[2] - difference);
        }
    }
}

#endif
