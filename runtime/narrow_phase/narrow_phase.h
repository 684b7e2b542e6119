/* From triangle pairs to contacts: representatives, feature volumes, elementary tests. */
#pragma once

#include "runtime/bvh/kernels.h"
#include "runtime/bvh/traversal.h"
#include "runtime/ccd/elementary.h"
#include "runtime/ccd/min_separation.h"
#include "runtime/culling/culling.h"
#include "runtime/narrow_phase/feature_queue.h"
#include "runtime/narrow_phase/orphan_pairs.h"
#include "runtime/narrow_phase/representatives.h"
#include "src/mesh/mesh.h"

/* The interval at hand; read by all lanes. */
typedef struct swept_interval {
    const cscd_mesh *mesh;
    const double *x0, *x1;
    const bvh *bvh; /* slots of triangle pairs */
    const representatives *representatives;
    const culling *culling; /* NULL: the representatives answer, or: */
    const bool *culled;     /* with culling: components whose pairs are answered for by the flags */
    bool strangers;         /* elsewhere pairs of adjacent triangles are not reached; others answer for
                             * theirs, and orphans are tested apart */
    bool closing;           /* with culling: the pairs reached are those that it culled before */
    separation limit;       /* distance 0: a contact is touching */
    bool collecting;        /* pairs of features are not tested, but become the lanes' candidates */
} swept_interval;

/* Pairs of features, as in a feature_list. */
typedef struct candidate_list {
    uint32_t (*pairs)[2];
    size_t count, capacity;
} candidate_list;

/* What one thread finds. */
typedef struct contact_lane {
    _Alignas(CACHE_LINE_SIZE) cscd_contact *contacts;
    size_t count, capacity;
    uint64_t feature_pairs;
    uint64_t decided[ELEMENTARY_LEVEL_COUNT]; /* elementary tests, by what decided them */
    uint64_t separations;                     /* tests for minimum separation */
    bool out_of_memory;
    feature_queue queue;
    candidate_list candidates[2]; /* by cscd_contact_kind */
} contact_lane;

void contact_lane_reset(contact_lane *lane);
void contact_lane_add(cscd_context *context, contact_lane *lane, cscd_contact_kind kind, uint32_t a,
                      uint32_t b, const elementary_hit *hit, bool bounded);

/* The points of vertex a and triangle b, or of the edges a and b. */
void narrow_phase_load(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                       elementary_query *query);

/* These put pairs in the lane's queue, which is decided when it is full, and by: */
void narrow_phase_finish(const swept_interval *interval, contact_lane *lane);

/* All pairs of features that pairs of triangles, given by their slots, answer for, that share no vertex and
 * that may touch by their volumes. */
void narrow_phase_test(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                       contact_lane *lane);

/* Those of the orphans of index, index + stride, and so on that no direction parts. */
void narrow_phase_test_orphans(const swept_interval *interval, const orphan_sets *orphans, uint32_t index,
                               uint32_t stride, contact_lane *lane);

/* One pair of features without a common vertex: a contact where they touch, or come within the limit's
 * distance. */
void narrow_phase_test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                          contact_lane *lane);
void narrow_phase_test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_lane *lane);
