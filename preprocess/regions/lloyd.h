/* Lloyd's iteration: k centroids of a set of points. */
#pragma once

#include "src/core/context.h"

enum { LLOYD_ROUNDS_MAX = 200 };

/* A set of points among positions, and where the result goes. */
typedef struct lloyd {
    cscd_context *context;
    const double *positions;
    const uint32_t *points; /* indices into positions */
    uint32_t point_count, k;
    double *centroids;  /* 3 * k */
    uint32_t *clusters; /* of each position; those of other sets stay */
    uint64_t *counts;   /* k, for its own use */
    uint32_t *scratch;  /* point_count, for its own use */
} lloyd;

/* Begins with k different points, 1 <= k <= point_count, and runs until no point changes its cluster, or for
 * LLOYD_ROUNDS_MAX rounds. A point goes to the first of its nearest centroids; an empty cluster keeps its
 * centroid. CANCELLED: the clusters mean nothing. */
cscd_status lloyd_run(const lloyd *l, uint64_t seed);
