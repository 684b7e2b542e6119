/* Declares the kernels of the BVH under the names that they have on the level that is being compiled. */
#pragma once

#include "runtime/bvh/bvh_kernels.h"
#include "runtime/bvh/traversal.h"
#include "src/core/simd.h"

void SIMD_NAME(copy_in)(const bvh *f, const bvh_tree *tree, uint32_t begin, uint32_t end, const double *x0,
                        const double *x1, copied *out);
void SIMD_NAME(refit)(const bvh *f, int level, uint32_t begin, uint32_t end);
extents SIMD_NAME(extents_at_start)(const bvh *f);
void SIMD_NAME(orient)(const bvh *f, const bvh_tree *tree, uint32_t begin, uint32_t end, const bool *clean,
                       uint8_t *orientations);
void SIMD_NAME(search)(const traversal *t, traversal_lane *lane, size_t visits_max);
