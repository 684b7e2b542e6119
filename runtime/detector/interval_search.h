/* The search of one interval: from the trees, moved there, to the lanes' contacts. */
#pragma once

#include "runtime/detector/detector.h"

typedef struct interval_search {
    cscd_detector *detector;
    swept_interval interval;
    cscd_timings timings;
    cscd_counters counters;
} interval_search;

/* From x0 to x1, with nothing in the lanes. */
interval_search interval_search_begin(cscd_detector *detector, const double *x0, const double *x1,
                                      separation limit);

/* Tests the pairs of one pass of the traversal. CANCELLED, as all below may be: not all of them. */
cscd_status interval_search_traverse(interval_search *search, traversal_pass pass);

/* Tests all pairs but those within components that are culled, for which the flags answer. Where nothing is
 * culled every pair of triangles is reached, so those that share a vertex, most of all pairs, need not be:
 * other pairs answer for their features, and there are orphans. */
cscd_status interval_search_everything(interval_search *search);

/* Are the pairs of adjacent triangles left out, of no component or of all? */
void interval_search_skip_adjacent(interval_search *search, bool everywhere);

/* OUT_OF_MEMORY: contacts are missing. */
cscd_status interval_search_lanes_status(const cscd_detector *d);

/* Every pair of features. */
cscd_status interval_search_by_brute_force(interval_search *search);
