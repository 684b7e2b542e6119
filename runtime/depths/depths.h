/* The depths of buried vertices, edges and triangles below the outer surfaces of bodies, at one moment:
 * docs/theory/curves.md, Lemmas 8 and 9. */
#pragma once

#include "runtime/intersections/intersections.h"

/* Finds depths, and keeps the memory of all calls. */
typedef struct depth_finder depth_finder;

/* NULL: no memory. */
depth_finder *depth_finder_create(cscd_context *context);

/* NULL is allowed. */
void depth_finder_destroy(depth_finder *d);

/* Gives back what it keeps from one call to the next. */
void depth_finder_clear(depth_finder *d);

/* The inputs of a call, in addition to the cuts. */
typedef struct depth_request {
    const bvh *bvh; /* its bounds are those of the surface's positions */
    const part_labels *labels;
    const cscd_intersection *pairs;
    size_t pair_count;
    double limit; /* see cscd_intersection_options */
} depth_request;

/* *out lives until the next call. OUT_OF_MEMORY and CANCELLED have no sentence. */
cscd_status depth_finder_run(depth_finder *d, const surface_cuts *found, const depth_request *request,
                             cscd_depths *out);
