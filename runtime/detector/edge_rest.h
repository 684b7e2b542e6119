/* Lengths of edges at rest, by which a barrier judges whether two of them are nearly parallel. */
#pragma once

#include "src/mesh/mesh_change.h"

typedef struct edge_rest {
    double *squared_lengths; /* per edge; NULL: rest is not known */
} edge_rest;

/* Takes the lengths from checked positions, in place of those before. On failure, those before stay: OUT_OF_MEMORY,
 * or INVALID_ARGUMENT for an edge whose length has no fourth power. */
cscd_status edge_rest_set(cscd_context *context, const cscd_mesh *mesh, const double *positions,
                          edge_rest *r);

/* Edges keep the lengths of their origins; of an edge without one nothing is known, so its threshold is 0. On failure
 * *out holds nothing. */
cscd_status edge_rest_move(cscd_context *context, const edge_rest *r, const cscd_mesh_change *change,
                           edge_rest *out);

/* mesh: the same one in the context of the copy. On failure *out is untouched. */
cscd_status edge_rest_copy(const edge_rest *r, const cscd_mesh *mesh, edge_rest *out);
void edge_rest_free(cscd_context *context, edge_rest *r);

/* The threshold of the mollifier (Li et al. 2020, eq. 24); 0 where rest is not known. */
static inline double edge_rest_threshold(const edge_rest *r, uint32_t a, uint32_t b) {
    return r->squared_lengths == NULL ? 0.0 : 1e-3 * r->squared_lengths[a] * r->squared_lengths[b];
}
