/* A search that goes its own way from the positions of an interval to its contacts, with trees and tests of its own: what stands in
 * place of the stages of a step, for methods to compare with. */
#pragma once

#include "runtime/narrow_phase/contact_lane.h"
#include "runtime/narrow_phase/swept_interval.h"

/* An interval, and what is known of its start. */
typedef struct own_interval {
    const swept_interval *swept;
    culling
        *culling; /* regions; the search says in it where detector points are and how triangles face them */
    const bool *culled; /* per component: pairs of its triangles may be left out */
    const bool *clean;  /* per triangle: it may be left out; NULL: all may */
    uint64_t ours;      /* of the detector's options: steps that are not done as published */
} own_interval;

typedef struct own_search {
    /* On failure, which has its sentence, *out is untouched. */
    cscd_status (*create)(cscd_context *context, uint64_t ours, void **out);
    void (*destroy)(cscd_context *context, void *state);

    /* Finds the pairs of triangles that are to be tested, and adds to the timings and counters. */
    cscd_status (*find_pairs)(void *state, const own_interval *interval, cscd_timings *timings,
                              cscd_counters *counters);

    /* Tests them, from the lane's cursor on; a full lane is suspended. */
    void (*test_pairs)(void *state, const own_interval *interval, contact_lane *lane);
} own_search;
