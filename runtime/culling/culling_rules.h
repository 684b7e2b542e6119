/* The rules by which a method leaves pairs of triangles out of a step. */
#pragma once

#include "runtime/bvh/bvh.h"

/* With none of these rules every pair is tested, and by_orientation alone loses no contact. */
typedef struct culling_rules {
    bool by_orientation; /* pairs of triangles of one region are culled by their orientation */
    bool where_it_pays;  /* ... in the components and intervals in which culling pays (culling_choice.h) */
    bool assumes_clean; /* as published: every triangle counts as clean at the start, and nothing is proven */
} culling_rules;

/* A stage between refit and orientation: it hides pairs of triangles in the BVH that, by its own test, do not touch in
 * the interval that the BVH was refitted to. */
typedef struct pair_hider {
    void *(*create)(cscd_context *context); /* NULL: out of memory */
    void (*destroy)(cscd_context *context, void *state);
    cscd_status (*hide)(void *state, bvh *f, const double *x0, const double *x1, cscd_counters *counters);
} pair_hider;
