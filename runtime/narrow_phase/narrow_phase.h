/* From triangle pairs to contacts: representatives, feature volumes, elementary tests. */
#pragma once

#include "runtime/narrow_phase/contact_worker.h"
#include "runtime/narrow_phase/representatives.h"
#include "runtime/narrow_phase/swept_interval.h"

/* ---- orphan pairs: features that only triangles with a common vertex contain --------------------------- */

/* A vertex and a triangle, or two edges, the one of the smaller number first. The two share no vertex, but
 * every triangle at the one shares a vertex with every triangle at the other (Tang et al. 2009). A mesh has
 * few of them: at corners of three triangles, and along boundaries. */
typedef struct orphan_pairs {
    uint32_t (*vf)[2], (*ee)[2];
    size_t vf_count, ee_count;
} orphan_pairs;

static inline bool triangles_share_vertex(const uint32_t a[3], const uint32_t b[3]) {
    return triangle_contains(b, a[0]) || triangle_contains(b, a[1]) || triangle_contains(b, a[2]);
}

/* *too_many is set when there are more than eight per triangle, as in a fan; *out is empty then. */
cscd_status orphan_pairs_create(const cscd_mesh *mesh, orphan_pairs *out, bool *too_many);

/* Those of a mesh that was made from another one, whose pairs are given: only what has changed is looked at.
 * mesh: the new one. On failure *out holds nothing. */
cscd_status orphan_pairs_move(const orphan_pairs *pairs, const cscd_mesh *mesh,
                              const cscd_mesh_change *change, orphan_pairs *out, bool *too_many);

/* On failure *out is untouched. */
cscd_status orphan_pairs_copy(const orphan_pairs *pairs, cscd_context *context, orphan_pairs *out);
void orphan_pairs_free(cscd_context *context, orphan_pairs *pairs);

/* ---- tests --------------------------------------------------------------------------------------------- */

/* These put pairs in the worker's queue, which is decided when it is full, and by: */
void narrow_phase_finish(const swept_interval *interval, contact_worker *worker);

/* All pairs of features that pairs of triangles, given by their slots, answer for, that share no vertex and
 * that may touch by their volumes. */
void narrow_phase_test(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                       contact_worker *worker);

/* The orphan pairs index, index + stride, and so on from the worker's cursor on, but those that a direction
 * parts. The worker may be suspended on the way. */
void narrow_phase_test_orphan_pairs(const swept_interval *interval, const orphan_pairs *orphans,
                                    uint32_t index, uint32_t stride, contact_worker *worker);

/* One pair of features without a common vertex: a contact where they touch, or come within the limit's
 * distance. */
void narrow_phase_test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                          contact_worker *worker);
void narrow_phase_test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_worker *worker);

/* Tests every pair of features that share no vertex: the reference that the other methods must equal. Runs
 * the share worker_index of worker_count of all pairs. Uses no tree: pairs are rejected by their own boxes in
 * double, which loses none, and by the test of the pair. */
void brute_force_test(const swept_interval *interval, uint32_t worker_index, uint32_t worker_count,
                      contact_worker *worker);

/* ---- searches of their own ----------------------------------------------------------------------------- */

/* An interval, and what is known of its start. */
typedef struct own_interval {
    const swept_interval *swept;
    /* Regions; the search writes into it where detector points are and how triangles face them. */
    culling *culling;
    const bool *culled; /* per component: pairs of its triangles may be left out */
    const bool *clean;  /* per triangle: it may be left out; NULL: all may */
    uint64_t ours;      /* of the detector's options: steps that are not done as published */
} own_interval;

/* A search that goes its own way from the positions of an interval to its contacts, with trees and tests of
 * its own: what stands in place of the stages of a step, for methods to compare with. */
typedef struct own_search {
    /* On failure, which has its sentence, *out is untouched. */
    cscd_status (*create)(cscd_context *context, uint64_t ours, void **out);
    void (*destroy)(cscd_context *context, void *state);

    /* Finds the pairs of triangles that are to be tested, and adds to the timings and counters. */
    cscd_status (*find_pairs)(void *state, const own_interval *interval, cscd_timings *timings,
                              cscd_counters *counters);

    /* Tests them, from the worker's cursor on; a full worker is suspended. */
    void (*test_pairs)(void *state, const own_interval *interval, contact_worker *worker);
} own_search;
