/* How deep what is buried lies below the outer surfaces of bodies. */
#pragma once

#include "runtime/depths/deepest_points.h"

/* A vertex that a body contains, or the part of an edge from s[0] to s[1]. */
typedef struct depth_question {
    uint32_t vertex, edge, face, patch, body;
    double s[2];
} depth_question;

/* The memory of all calls; begins with the context, also of outer, its cuts and the deepest, and nothing else set. */
typedef struct depth_finder {
    cscd_context *context;
    outer_surface outer;
    deepest_finder deepest;
    depth_question *questions;
    size_t question_count, question_capacity;
    cscd_depth *depths;
    size_t depth_capacity;
    cscd_patch_depth *patches;
    size_t patch_capacity;
} depth_finder;

void depth_finder_free(depth_finder *d);

/* What depths are asked of, beside the cuts. */
typedef struct depth_request {
    const bvh *bvh; /* its bounds are those of the surface's positions */
    const part_labels *labels;
    const cscd_intersection_pair *pairs;
    size_t pair_count;
    double limit; /* see cscd_intersection_options */
} depth_request;

/* *out lives until the next call. OUT_OF_MEMORY and CANCELLED have no sentence. */
cscd_status depth_finder_run(depth_finder *d, const surface_cuts *found, const depth_request *request,
                             cscd_depths *out);
