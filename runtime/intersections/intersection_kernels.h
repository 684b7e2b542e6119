/* The kernels of the static check. */
#pragma once

#include "runtime/bvh/traversal.h"
#include "src/core/kernels.h"

typedef struct intersection_kernels {
    /* Removes from a list of pairs of different triangles, in place and without keeping their order, those that
     * certainly do not intersect (see src/mesh/triangle_intersection.h) at positions that positions_check has
     * accepted. Pairs that share three vertices do not; they are kept only on demand. Returns how many are left, in
     * an order that is the same on every level. */
    uint32_t (*reject_disjoint)(const uint32_t (*triangles)[3], const double *positions, triangle_pair *pairs,
                                uint32_t count, bool keep_duplicates);

    /* Removes from a list of triangles, in place, those that certainly have an area. Returns how many are left. */
    uint32_t (*reject_with_area)(const uint32_t (*triangles)[3], const double *positions, uint32_t *list,
                                 uint32_t count);
} intersection_kernels;

DECLARE_KERNELS(intersection_kernels);

static inline const intersection_kernels *intersection_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, intersection_kernels);
}
