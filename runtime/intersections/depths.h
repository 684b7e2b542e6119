/* How deep what is buried lies below the outer surfaces of objects. */
#pragma once

#include "runtime/intersections/outer_surface.h"

#include <cscd/depths.h>

/* A vertex that an object contains, or the part of an edge from s[0] to s[1]. */
typedef struct depth_question {
    uint32_t vertex, edge, patch, object;
    double s[2];
} depth_question;

/* A number for sorting, and an item. */
typedef struct depth_key {
    uint64_t number, item;
} depth_key;

/* The memory of all calls; begins with the context, also of outer and its cuts, and nothing else set. */
typedef struct depth_finder {
    cscd_context *context;
    outer_surface outer;
    depth_question *questions;
    size_t question_count, question_capacity;
    cscd_depth *depths;
    depth_key *keys, *spare_keys;
    cscd_patch_depth *patches;
    size_t depth_capacity; /* of these four */
} depth_finder;

void depth_finder_free(depth_finder *d);

/* *out lives until the next call. OUT_OF_MEMORY and CANCELLED have no sentence. The bounds of the trees are those of the
 * surface's positions. */
cscd_status depth_finder_run(depth_finder *d, const surface_cuts *found, const bvh *f, cscd_depths *out);
