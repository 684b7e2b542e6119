/* The searches of a detector: the data that they work with and keep, one search of an interval from trees that are refitted
 * to it to the contacts of the workers, and candidates, which serve every shorter motion. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "runtime/loose/loose.h"
#include "runtime/narrow_phase/narrow_phase.h"

/* ---- the data ------------------------------------------------------------------------------------------ */

typedef struct search_space {
    cscd_context *context;
    const cscd_mesh *mesh;
    bvh bvh; /* refitted to the current interval or moment before a search begins */
    traversal traversal;
    const pair_rules *rules; /* NULL: all objects are looked at */
    active_set active;       /* the trees have marks of it */
    contact_worker *workers; /* one per worker of the traversal */
    size_t longest;          /* list of the present search; 0: there is no cap */
    /* Lists of this many contacts are moved out of the workers, which give back their memory; shorter ones are copied, so
     * that later steps take none from the allocator. */
    size_t moves_from;
    size_t counted; /* contacts of the list that found no room in the workers; then no list is given out */
    representatives representatives;
    /* Made by the first search that skips adjacent triangles, unless there are too many. */
    orphan_pairs orphans;
    bool orphans_known, orphans_usable;
    loose_elements loose;
    bool *skipped; /* per component: pairs of its adjacent triangles are not traversed */
} search_space;

/* The trees are not built yet. On failure *out holds nothing. */
cscd_status search_space_create(const cscd_mesh *mesh, search_space *out);
void search_space_destroy(search_space *s);

/* OUT_OF_MEMORY: a worker had no room for a contact. */
cscd_status search_space_status(const search_space *s);

/* Does any worker have a contact? */
bool search_space_found_any(const search_space *s);

/* ---- the search of one interval ------------------------------------------------------------------------ */

typedef struct interval_search {
    search_space *space;
    swept_interval interval;
    cscd_timings timings;
    cscd_counters counters;
    void (*spill)(void *data); /* makes room in workers that are suspended; NULL: no worker has a limit */
    void *spill_data;
} interval_search;

/* Runs a task on the first workers until none is suspended any more. Each goes on from its cursor, which is 0 at first. */
void interval_search_run(interval_search *search, uint32_t workers, parallel_task *task, void *data);

/* Begins the search from x0 to x1, with nothing in the workers. */
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

/* Skips the pairs of adjacent triangles of all components, or of none. */
void interval_search_skip_adjacent(interval_search *search, bool everywhere);

/* Tests the pairs of loose features without trees. */
cscd_status interval_search_all_loose(interval_search *search);

/* Tests every pair of features, without the trees. */
cscd_status interval_search_by_brute_force(interval_search *search);

/* ---- candidates ---------------------------------------------------------------------------------------- */

/* Pairs of features that may come near each other on a motion, kept for every shorter motion. */
typedef struct candidates {
    candidate_list lists[2]; /* by cscd_contact_kind */
} candidates;

/* The candidates that are wanted: all pairs that come within what they have to keep and the reach, as computed with this
 * margin. */
typedef struct candidate_quest {
    search_space *space;
    bvh_rebuild *rebuild; /* of its trees */
    volume_growth growth; /* of a step, whose distances are those that pairs keep */
    double reach, margin;
} candidate_quest;

/* Collects every such pair, by its bounding volumes, between x0 and x1. Nothing is culled. The candidates of before are
 * replaced, and their memory is used again. */
cscd_status candidates_collect(const candidate_quest *quest, const double *x0, const double *x1,
                               candidates *out);

/* Takes over what the workers have collected, in place of what there was. OUT_OF_MEMORY: what there is now is not all. */
cscd_status candidates_take(const search_space *s, candidates *out);
void candidates_free(cscd_context *context, candidates *c);

/* Tests all candidates in the interval that the search has begun with, and all vertices against half-spaces. */
cscd_status candidates_test(const candidates *c, interval_search *search);
