/* The kernels of the static check. */
#pragma once

#include "runtime/bvh/traversal.h"
#include "src/core/kernels.h"

typedef struct intersection_kernels {
    /* Of pairs of different triangles, in place and in any order, keeps those that may intersect (see
     * src/mesh/triangle_intersection.h) at positions, which are as positions_check wants them; returns how
     * many. */
    uint32_t (*reject_disjoint)(const uint32_t (*triangles)[3], const double *positions, triangle_pair *pairs,
                                uint32_t count);

    /* Of triangles, in place, keeps those that may be without area. */
    uint32_t (*reject_with_area)(const uint32_t (*triangles)[3], const double *positions, uint32_t *list,
                                 uint32_t count);
} intersection_kernels;

DECLARE_KERNELS(intersection_kernels);

static inline const intersection_kernels *intersection_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, intersection_kernels);
}
