/* One method on one recording, compared with the method that leaves out no pair. */
#pragma once

#include "benchmarks/lib/scene_files.h"

/* The contacts of method none in each interval, and which intervals begin with every component proven
 * embedded. */
typedef struct truth {
    const recording_data *recording;
    uint32_t *vertex_components;
    cscd_contact *contacts; /* interval i: contacts[offsets[i] .. offsets[i + 1]) */
    size_t *offsets;
    bool *proven;
    uint32_t proven_count;
} truth;

bool truth_find(const recording_data *r, truth *out, io_error *error);
void truth_free(truth *t);

typedef struct entrant {
    char name[32]; /* name of the row */
    cscd_method method;
    cscd_mode mode;
    uint32_t k, seed; /* of k-means; repeat i has the seed seed + i */
    cscd_volume volume;
    uint64_t ours; /* of the published methods */
} entrant;

/* Sums over intervals. */
typedef struct score {
    uint32_t intervals;
    cscd_timings ms;
    double pcp, tests, contacts;
    double lost;          /* per run: contacts of method none that are not reported */
    double earliest_lost; /* per run: intervals and components whose first contact is not reported in time */
    double invented;      /* per run: contacts that method none does not report; of published methods alone */
} score;

enum { CLASS_PROVEN, CLASS_OTHER, CLASS_COUNT };

/* Means over the repeats, for intervals with a proven start and for others, and the least and greatest
 * time per interval of a repeat over all intervals. */
typedef struct contest_result {
    entrant entrant;
    score classes[CLASS_COUNT];
    double least_ms, most_ms;
} contest_result;

/* Replays `repeats` times. Returns false when a call failed or the contacts of an interval break the
 * guarantee that the method gave for it; *error says which. Published methods may lose and invent anything; no other may
 * add or alter a contact. */
bool contest_run(const truth *t, const entrant *e, uint32_t repeats, contest_result *out, io_error *error);

/* Returns the means per interval of one class, or of both when only is CLASS_COUNT; losses are not
 * divided. */
score score_mean(const score classes[CLASS_COUNT], int only);
