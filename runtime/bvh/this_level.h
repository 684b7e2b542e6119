/* The kernels under the names that they have on the level that is compiled. */
#pragma once

#include "runtime/bvh/kernels.h"
#include "runtime/bvh/traversal.h"
#include "runtime/narrow_phase/representatives.h"
#include "src/core/simd.h"

void SIMD_NAME(copy_in)(const bvh *f, const bvh_tree *p, uint32_t begin, uint32_t end, const double *x0,
                        const double *x1, copied *out);
void SIMD_NAME(refit)(const bvh *f, int level, uint32_t begin, uint32_t end);
extents SIMD_NAME(extents_at_start)(const bvh *f);
void SIMD_NAME(orient)(const bvh *f, const bvh_tree *p, uint32_t begin, uint32_t end, const uint8_t *states,
                       uint8_t *orientations);
void SIMD_NAME(search)(const traversal *t, traversal_lane *lane, size_t visits_max);

void SIMD_NAME(feature_filter)(const bvh *f, const triangle_pair *pairs, uint32_t count, double distance,
                               uint16_t *features);
void SIMD_NAME(represent)(const cscd_mesh *mesh, const representatives *r, const triangle_pair *pairs,
                          uint32_t count, uint16_t *features, uint16_t *open);

uint32_t SIMD_NAME(keep_meeting)(const uint32_t (*triangles)[3], const double *positions,
                                 triangle_pair *pairs, uint32_t count);
uint32_t SIMD_NAME(keep_thin)(const uint32_t (*triangles)[3], const double *positions, uint32_t *list,
                              uint32_t count);
