/* The kernels of the static check. */
#pragma once

#include "runtime/bvh/traversal.h"
#include "runtime/intersections/vertex_stars.h"
#include "src/core/kernels.h"

typedef struct intersection_kernels {
    /* Removes from a list of pairs of different triangles, in place and without keeping their order, those that
     * certainly do not intersect (see src/mesh/triangle_intersection.h) at positions that positions_check has
     * accepted. Pairs that share three vertices do not; they are kept only on demand. Pairs in which an edge certainly
     * passes through the inside of the other face move to crossing, which has room for all. Returns how many are left.
     * All orders are the same on every level. */
    uint32_t (*reject_disjoint)(const uint32_t (*triangles)[3], const double *positions, triangle_pair *pairs,
                                uint32_t count, bool keep_duplicates, triangle_pair *crossing,
                                uint32_t *crossing_count);

    /* Writes for each triangle of a list which signs its normal certainly has, and where its corners rise: see
     * vertex_stars.h. A triangle whose normal certainly has a sign has an area. */
    void (*sign_normals)(const uint32_t (*triangles)[3], const double *positions, const uint32_t *list,
                         uint32_t count, uint8_t *normals, uint8_t *rises);
} intersection_kernels;

DECLARE_KERNELS(intersection_kernels);

static inline const intersection_kernels *intersection_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, intersection_kernels);
}
