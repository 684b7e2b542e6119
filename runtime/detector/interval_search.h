/* The search of one interval: from the trees, refitted to it, to the lanes' contacts. */
#pragma once

#include "runtime/detector/search_space.h"

typedef struct interval_search {
    search_space *space;
    swept_interval interval;
    cscd_timings timings;
    cscd_counters counters;
    void (*spill)(void *data); /* makes room in lanes that are suspended; NULL: no lane has a limit */
    void *spill_data;
} interval_search;

/* Runs a task on the first lanes until none is suspended any more. Each goes on from its cursor, which is 0 at first. */
void interval_search_run(interval_search *search, uint32_t lanes, parallel_task *task, void *data);

/* Begins the search from x0 to x1, with nothing in the lanes. */
interval_search interval_search_begin(search_space *space, const double *x0, const double *x1,
                                      separation limit);

/* Tests the pairs of one pass of the traversal. CANCELLED, here and below: not all of them are tested. */
cscd_status interval_search_traverse(interval_search *search, traversal_pass pass);

/* Tests all pairs except those that culling leaves out. In components that are not culled the traversal reaches
 * every pair of triangles, so there it skips those that share a vertex, which are most of all pairs: other pairs
 * test their features, and orphan pairs are tested separately. */
cscd_status interval_search_everything(interval_search *search);

/* Tests the pairs of loose features, with triangles, with each other, and vertices with half-spaces. The trees have been
 * refitted. No other function here does, but brute force. */
cscd_status interval_search_loose(interval_search *search);

/* Tests all vertices against the half-spaces. */
void interval_search_half_spaces(interval_search *search);

/* Skips the pairs of adjacent triangles of all components, or of none. */
void interval_search_skip_adjacent(interval_search *search, bool everywhere);

/* Tests the pairs of loose features without trees. */
cscd_status interval_search_all_loose(interval_search *search);

/* Tests every pair of features, without the trees. */
cscd_status interval_search_by_brute_force(interval_search *search);
