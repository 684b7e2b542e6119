/* The deepest point of a part of an edge: docs/theory/curves.md, Lemma 8. */
#pragma once

#include "runtime/depths/near_surface.h"

/* A place on an edge; distance: scaled. */
typedef struct edge_place {
    double s, x[3], distance;
    outer_point nearest;
} edge_place;

/* The part of an edge that a body contains. */
typedef struct edge_search {
    const outer_surface *outer;
    const surface_cuts *found;
    const bvh *bvh;
    uint32_t body;
    const double *ends[2];
    double s[2];             /* where on the edge it begins, and ends */
    double length;           /* of the edge; scaled */
    const outer_point *near; /* the last answer, or NULL */
} edge_search;

edge_place edge_search_run(const edge_search *e);
