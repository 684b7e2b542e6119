/* How long edges are at rest, by which a barrier judges whether two of them are nearly parallel. */
#pragma once

#include "src/mesh/mesh.h"

typedef struct edge_rest {
    double *squared_lengths; /* per edge; NULL: rest is not known */
} edge_rest;

/* Takes the lengths from checked positions, in place of those before. On failure, those before stay: OUT_OF_MEMORY,
 * or INVALID_ARGUMENT for an edge whose length has no fourth power. */
cscd_status edge_rest_set(cscd_context *context, const cscd_mesh *mesh, const double *positions,
                          edge_rest *r);
void edge_rest_free(cscd_context *context, edge_rest *r);

/* The threshold of the mollifier (Li et al. 2020, eq. 24); 0 where rest is not known. */
static inline double edge_rest_threshold(const edge_rest *r, uint32_t a, uint32_t b) {
    return r->squared_lengths == NULL ? 0.0 : 1e-3 * r->squared_lengths[a] * r->squared_lengths[b];
}
