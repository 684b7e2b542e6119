/* The contacts of method none on a recording, and methods by turns on it, compared with these. */
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

typedef struct contact_losses {
    double lost;          /* contacts of method none that are not reported */
    double earliest_lost; /* intervals and components whose first contact is not reported in time */
    double invented;      /* contacts that method none does not report; of published methods alone */
} contact_losses;

/* Adds what the list of an interval lacks. False: it breaks the guarantee of its method. Published methods may lose and invent
 * anything; no other may add or alter a contact. */
bool truth_compare(const truth *t, uint32_t interval, const cscd_detector *detector, cscd_method method,
                   cscd_mode mode, const cscd_contacts *found, contact_losses *s);

/* ---- contests ------------------------------------------------------------------------------------------ */

typedef struct entrant {
    char name[48]; /* name of the row */
    cscd_method method;
    cscd_mode mode;
    cscd_volume volume;
    uint64_t ours;             /* of the published methods */
    cscd_method plan;          /* CHARGE: that of the recording; KMEANS, PUBLISHED: a new one; others: none */
    uint64_t plan_ours;        /* of a published plan */
    double threshold, growing; /* of a published plan; 0: the defaults */
    uint32_t k, runs;          /* of k-means: with the seeds from 1 to runs */
} entrant;

/* Sums over intervals. */
typedef struct score {
    uint32_t intervals, timed; /* the first interval, which builds the trees, is not timed */
    cscd_timings ms;
    double pcp, apart, tests,
        contacts;          /* apart: pairs of triangles that share no vertex, or are tested all the same */
    contact_losses losses; /* per run */
} score;

enum { CLASS_PROVEN, CLASS_OTHER, CLASS_COUNT };

/* Sums over the runs, for intervals with a proven start and for others, and the least and greatest mean of a run. */
typedef struct contest_result {
    entrant entrant;
    score classes[CLASS_COUNT];
    double least_ms, most_ms, least_apart, most_apart;
    uint32_t regions; /* of the last plan; 0: there is none */
} contest_result;

/* All entrants replay in turn, `rounds` times, and of each interval the round with the least processor time counts. False: a call
 * failed or the contacts of an interval break the guarantee that the method gave for it; *error says which. */
bool contest_run(const truth *t, const entrant *entrants, uint32_t count, uint32_t rounds,
                 contest_result *out, io_error *error);

/* Returns the means per interval of one class, or of both when only is CLASS_COUNT; losses are not
 * divided. */
score score_mean(const score classes[CLASS_COUNT], int only);
