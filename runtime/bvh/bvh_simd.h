/* Shared by the kernels: their names on the level that is compiled, and the corners and volumes of a leaf's eight
 * triangles. */
#pragma once

#include "runtime/bvh/bvh_parts.h"
#include "src/core/simd.h"

/* ---- kernels ----------------------------------------------------------------------------------------------- */

void SIMD_NAME(copy_in)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                        const double *x0, const double *x1, copied *out);
void SIMD_NAME(refit)(const bvh *hierarchy, int level, uint32_t begin, uint32_t end);
extents SIMD_NAME(extents_at_start)(const bvh *hierarchy);
void SIMD_NAME(orient)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                       const bool *clean, uint8_t *orientations);
void SIMD_NAME(orient_lasting)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                               const bool *clean, const orientation_lasting *lasting, uint8_t *orientations);
double SIMD_NAME(skin_move)(bvh_skin *s, uint32_t begin, uint32_t end, const double *x,
                            const double origin[3]);
bool SIMD_NAME(skin_signs)(const bvh_skin *s, uint32_t begin, uint32_t end, const double *x0,
                           const double *x1);

/* Writes which triangles are PLUS and MINUS, seen from the tree's detector point, of corners[i][end][axis] in its frame. */
void SIMD_NAME(orient_corners)(const bvh_tree *tree, f32x8 (*corners)[2][3], uint32_t *plus, uint32_t *minus);
void SIMD_NAME(near_children)(const float *bounds, const framed_query *q, float *out);
uint32_t SIMD_NAME(near_triangles)(const bvh *hierarchy, const bvh_tree *tree, const bvh_leaf *leaf,
                                   const framed_query *q, double squared);
void SIMD_NAME(search)(const traversal *t, traversal_worker *worker, size_t visits_max);

/* ---- corners and volumes of a leaf ------------------------------------------------------------------------- */

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
