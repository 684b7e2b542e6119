/* Pairs of features that only triangles with a common vertex contain. */
#pragma once

#include "src/mesh/mesh.h"

/* Vertex and triangle, or two edges of which the first has the smaller number; the two have no common vertex,
 * but every triangle at the one has one with every triangle at the other (Tang et al. 2009). A mesh has few:
 * at corners of three triangles, and along boundaries. */
typedef struct orphan_sets {
    uint32_t (*vf)[2], (*ee)[2];
    size_t vf_count, ee_count;
} orphan_sets;

static inline bool triangles_share_vertex(const uint32_t a[3], const uint32_t b[3]) {
    return triangle_contains(b, a[0]) || triangle_contains(b, a[1]) || triangle_contains(b, a[2]);
}

/* *too_many: there are more than eight per triangle, as in a fan, and *out stays empty. */
cscd_status orphan_sets_create(const cscd_mesh *mesh, orphan_sets *out, bool *too_many);
void orphan_sets_free(cscd_context *context, orphan_sets *sets);
