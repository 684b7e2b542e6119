/* The continuous contour test: does the projection of a patch's contour stay a simple closed curve? */
#pragma once

#include "src/mesh/mesh.h"

/* An edge of a contour, projected: ends a and b, at both ends of the interval. */
typedef struct contour_edge {
    double a[2][2], b[2][2]; /* [time][axis] */
    double low[2], high[2];  /* the box that it stays in, rounding included */
    uint32_t vertices[2];
} contour_edge;

/* Where an edge's box begins, for sorting. */
typedef struct contour_key {
    double low;
    uint32_t edge; /* in the list of edges */
} contour_key;

/* A contour and its motion. */
typedef struct contour_query {
    const cscd_mesh *mesh;
    const uint32_t *edges; /* of the mesh; or NULL */
    const uint32_t *loop;  /* or its vertices in order, with the surface on their left */
    uint32_t edge_count;
    const double *x0, *x1;
    const float *axis; /* along which the contour is projected, of about unit length */
    uint32_t skipped;  /* pairs among the first `skipped` edges count as tested already */
    bool published;    /* only motions are tested, not the start */
} contour_query;

/* A way to test contours that are one loop. */
typedef struct contour_test {
    bool by_loops;        /* it takes the vertices in order, else the edges */
    uint32_t leaf_height; /* of the trees whose nodes it tests: see patch_tree_build */
    size_t scratch_size;  /* bytes per edge */
    bool (*passes)(const contour_query *query, void *scratch);
} contour_test;

/* That of ICCD: contour_stays_simple. */
extern const contour_test sweep_test;

/* Certified for edges that form one loop: true only if no two of them touch in the projection at any moment of the
 * interval, except neighbours at their common vertices. For a loop of three edges it tests nothing, because such a
 * loop is simple as long as its projection has an area. edges, keys: room for edge_count of them. */
bool contour_stays_simple(const contour_query *query, contour_edge *edges, contour_key *keys);
