/* Declares the kernels of the BVH under the names that they have on the level that is being compiled. */
#pragma once

#include "runtime/bvh/bvh_kernels.h"
#include "runtime/bvh/bvh_query.h"
#include "runtime/bvh/bvh_skin.h"
#include "runtime/bvh/traversal.h"
#include "src/core/simd.h"

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
void SIMD_NAME(search)(const traversal *t, traversal_lane *lane, size_t visits_max);
