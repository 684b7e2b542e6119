/* Picks the one triangle pair that tests a feature pair, so that no feature pair is tested twice. */
#pragma once

#include "runtime/narrow_phase/swept_interval.h"
#include "src/mesh/mesh_change.h"

/* ---- a quick proof that two triangles are not near each other on the surface ------------------------- */

/* The ring of a triangle is all triangles that share a vertex with it, itself among them. The vertices of an
 * object are cut into small connected patches, and a mark has a bit for each patch that a vertex of the
 * triangle's ring is in, by the number of the patch modulo 58 (a Bloom filter). If two marks have no such bit
 * in common, no triangle of the one ring shares a vertex with any of the other. The six lowest bits are free
 * for the caller, and stay as they are. */
enum { RING_MARK_FIRST_BIT = 6 };

static inline bool rings_may_touch(uint64_t mark_a, uint64_t mark_b) {
    return (mark_a & mark_b) >> RING_MARK_FIRST_BIT != 0;
}

/* Adds the bits of the rings to the marks of an object's triangles. */
cscd_status ring_marks_add(const cscd_mesh *mesh, const object_range *range, uint64_t *marks);

/* ---- representatives ---------------------------------------------------------------------------------- */

/* A feature's representative is the first triangle of its star (Tang et al. 2009). The pair of the
 * representatives tests a pair of features, unless the two are adjacent and such pairs are skipped. */
typedef struct representatives {
    /* Per triangle: bit i says that it represents its vertex i, bit 3 + i its edge i; see ring_marks_add. */
    uint64_t *marks;
    uint32_t (*others)[2]; /* per vertex: the other vertices of its representative */
    uint32_t *opposite;    /* per edge: the vertex of its representative that is not the edge's */
} representatives;

/* On failure *out holds nothing. */
cscd_status representatives_create(const cscd_mesh *mesh, representatives *out);

/* Those of a mesh that was made from another one, of objects that have not changed from r; mesh: the new
 * one. On failure *out is untouched. */
cscd_status representatives_move(const representatives *r, const cscd_mesh *mesh,
                                 const cscd_mesh_change *change, representatives *out);

/* In this and other functions that copy, mesh is the same one in the context of the copy, and on failure
 * *out is untouched. */
cscd_status representatives_copy(const representatives *r, const cscd_mesh *mesh, representatives *out);
void representatives_free(cscd_context *context, representatives *r);

/* The features that a triangle represents, as in marks. */
static inline uint32_t represented_features(const representatives *r, uint32_t triangle) {
    return (uint32_t)r->marks[triangle] & ((1u << RING_MARK_FIRST_BIT) - 1);
}

/* The features that a pair of triangles tests at most, known before anything else about the pair. If
 * `settled`, it tests all of them; otherwise representatives_select says which. */
typedef struct pair_selection {
    uint16_t features;
    bool settled;
} pair_selection;

pair_selection representatives_select_early(const swept_interval *interval, triangle_pair pair);

/* Keeps, of the pairs of features of pairs of triangles, bits as in FEATURE_VERTEX_B and FEATURE_EDGES, those
 * that these triangle pairs test. */
void representatives_select(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                            uint16_t *features);
