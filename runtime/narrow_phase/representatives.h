/* Picks the one triangle pair that tests a feature pair, so that no feature pair is tested twice. */
#pragma once

#include "runtime/narrow_phase/ring_marks.h"
#include "runtime/narrow_phase/swept_interval.h"

/* A feature's representative is the first triangle of its star (Tang et al. 2009). The pair of the
 * representatives tests a pair of features, unless the two are adjacent and such pairs are skipped. */
typedef struct representatives {
    uint64_t *
        marks; /* per triangle: bit i says that it represents its vertex i, bit 3 + i its edge i; see ring_marks.h */
    uint32_t (*others)[2]; /* per vertex: the other vertices of its representative */
    uint32_t *opposite;    /* per edge: the vertex of its representative that is not the edge's */
} representatives;

/* On failure *out holds nothing. */
cscd_status representatives_create(const cscd_mesh *mesh, representatives *out);

/* Those of a mesh that was made from another one, of objects that have not changed from r; mesh: the new one. On
 * failure *out is untouched. */
cscd_status representatives_move(const representatives *r, const cscd_mesh *mesh,
                                 const cscd_mesh_change *change, representatives *out);

/* In this and other functions that copy, mesh is the same one in the context of the copy, and on failure *out is
 * untouched. */
cscd_status representatives_copy(const representatives *r, const cscd_mesh *mesh, representatives *out);
void representatives_free(cscd_context *context, representatives *r);

/* The features that a triangle represents, as in marks. */
static inline uint32_t represented_features(const representatives *r, uint32_t triangle) {
    return (uint32_t)r->marks[triangle] & ((1u << RING_MARK_FIRST_BIT) - 1);
}

/* What a pair of triangles tests at most, known before anything else of it. settled: and all of it; else
 * representatives_select says which. */
typedef struct pair_selection {
    uint16_t features;
    bool settled;
} pair_selection;

pair_selection representatives_select_early(const swept_interval *interval, triangle_pair pair);

/* Keeps, of the pairs of features of pairs of triangles, bits as in FEATURE_VERTEX_B and FEATURE_EDGES, those
 * that these triangle pairs test. */
void representatives_select(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                            uint16_t *features);
