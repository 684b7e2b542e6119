/* One method on one recording, held against the method that leaves out no pair. */
#pragma once

#include "benchmarks/lib/scene_files.h"

/* What method none finds in each interval, and which of them begin with every component proven embedded. */
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
    char name[32]; /* of the row */
    cscd_method method;
    cscd_mode mode;
    uint32_t k, seed; /* k-means; repeat i has seed + i */
    cscd_volume volume;
} entrant;

/* Sums over intervals. */
typedef struct score {
    uint32_t intervals;
    cscd_timings ms;
    double pcp, tests, contacts;
    double lost;          /* per run: contacts of method none that are not reported, */
    double earliest_lost; /* and intervals and components whose first contact is not reported in time */
} score;

enum { CLASS_PROVEN, CLASS_OTHER, CLASS_COUNT };

/* Means over repeats, in intervals with a proven start and in others, and the repeats' least and greatest
 * time per interval over all of them. */
typedef struct contest_result {
    entrant entrant;
    score classes[CLASS_COUNT];
    double least_ms, most_ms;
} contest_result;

/* Replays `repeats` times. False: *error says that a call failed, or which interval's contacts break the
 * guarantee that the method gave for it. Published methods may lose anything; none may add or alter a
 * contact. */
bool contest_run(const truth *t, const entrant *e, uint32_t repeats, contest_result *out, io_error *error);

/* Of one class, or, where only is CLASS_COUNT, of both; means per interval, losses as they are. */
score score_mean(const score classes[CLASS_COUNT], int only);
