/* All kinds of volumes on one recording, interval by interval and by turns: what they cost and what they find. */
#pragma once

#include "benchmarks/lib/scene_files.h"
#include "runtime/baselines/volume_tree.h"
#include "runtime/culling/culling.h"

enum { VOLUME_ROUNDS = 5 };

typedef enum volume_stage {
    VOLUME_REFIT,
    VOLUME_SEARCH,
    VOLUME_FILTERED, /* tests of what was found as in a step: representatives, feature filter, elementary tests */
    VOLUME_DIRECT, /* the same without the feature filter */
    VOLUME_STAGES
} volume_stage;

/* Means per interval. */
typedef struct volume_cost {
    double tests, pairs, adjacent;
    double ms[VOLUME_STAGES];                    /* of the median of the rounds of each interval */
    double rounds[VOLUME_STAGES][VOLUME_ROUNDS]; /* of one round */
} volume_cost;

typedef struct volume_result {
    cscd_method method;
    uint32_t intervals; /* measured */
    double contacts;    /* of the method's own steps, per interval */
    volume_cost of[VOLUME_KINDS];
} volume_result;

/* Measures every stride-th interval with the culling of a method: NONE, or one by orientation with the plan of the
 * recording. False when something failed, or when a kind misses a pair of triangles whose features are in contact, finds
 * what a k-DOP with fewer directions does not, or leads to other contacts. */
bool volume_trial_run(const recording_data *r, cscd_method method, cscd_simd simd, uint32_t stride,
                      volume_result *out, io_error *error);

/* ---- checks -------------------------------------------------------------------------------------------- */

/* Pairs of triangles that have to be found: of the stars of two features in contact, those that share no vertex and that
 * culling keeps. The smaller number in the upper half; ascending. */
typedef struct wanted_pairs {
    uint64_t *keys;
    bool *marks;
    size_t count, capacity;
} wanted_pairs;

/* Replaces what was there. False: no memory. */
bool wanted_pairs_collect(wanted_pairs *p, const cscd_mesh *mesh, const culling *by,
                          const cscd_contacts *contacts);
void wanted_pairs_free(wanted_pairs *p);

/* Were all of them found? */
bool wanted_pairs_found(wanted_pairs *p, const volume_search *s);

/* Are all pairs of one search those of another one, in the same order, and did it test no more volumes? */
bool volume_search_within(const volume_search *s, const volume_search *of);
