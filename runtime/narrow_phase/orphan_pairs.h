/* Pairs of features that only triangles with a common vertex contain. */
#pragma once

#include "src/mesh/mesh_change.h"

/* A vertex and a triangle, or two edges, the one of the smaller number first. The two share no vertex, but
 * every triangle at the one shares a vertex with every triangle at the other (Tang et al. 2009). A mesh has
 * few of them: at corners of three triangles, and along boundaries. */
typedef struct orphan_pairs {
    uint32_t (*vf)[2], (*ee)[2];
    size_t vf_count, ee_count;
} orphan_pairs;

static inline bool triangles_share_vertex(const uint32_t a[3], const uint32_t b[3]) {
    return triangle_contains(b, a[0]) || triangle_contains(b, a[1]) || triangle_contains(b, a[2]);
}

/* *too_many is set when there are more than eight per triangle, as in a fan; *out is empty then. */
cscd_status orphan_pairs_create(const cscd_mesh *mesh, orphan_pairs *out, bool *too_many);

/* Those of a mesh that was made from another one, whose pairs are given: only what has changed is looked at. mesh: the new
 * one. On failure *out holds nothing. */
cscd_status orphan_pairs_move(const orphan_pairs *pairs, const cscd_mesh *mesh,
                              const cscd_mesh_change *change, orphan_pairs *out, bool *too_many);

/* On failure *out is untouched. */
cscd_status orphan_pairs_copy(const orphan_pairs *pairs, cscd_context *context, orphan_pairs *out);
void orphan_pairs_free(cscd_context *context, orphan_pairs *pairs);
