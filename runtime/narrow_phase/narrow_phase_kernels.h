/* The kernels of the narrow phase: from pairs of triangles to the pairs of their features. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "runtime/narrow_phase/representatives.h"
#include "src/core/kernels.h"

/* Keeps, of the given pairs of features of two triangles, in slots, those that may touch, or come within
 * their distance, by their volumes, and that share no vertex. apart: the caller knows that the triangles
 * share none. */
typedef void feature_filter_kernel(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                                   bool apart, uint16_t *features);

/* Keeps, of the features of pairs of triangles, those that these triangles represent. open: the features
 * whose representatives share a vertex although the features share none. */
typedef void represent_kernel(const cscd_mesh *mesh, const representatives *r, const triangle_pair *pairs,
                              uint32_t count, uint16_t *features, uint16_t *open);

typedef struct narrow_phase_kernels {
    feature_filter_kernel *feature_filter;
    represent_kernel *represent;
} narrow_phase_kernels;

DECLARE_KERNELS(narrow_phase_kernels);

static inline const narrow_phase_kernels *narrow_phase_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, narrow_phase_kernels);
}
