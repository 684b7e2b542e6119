/* A replay under way: what it reads, how far it is, what it has found, and the functions of its parts. */
#pragma once

#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/common/methods.h"
#include "tool/common/plans.h"
#include "tool/common/terminal.h"
#include "tool/replay/replay_options.h"
#include "tool/replay/replay_source.h"

/* One interval's results, as the summary and the table need them. */
typedef struct interval_result {
    int32_t frame; /* its number */
    interval_state state;
    size_t contact_count;
    double earliest_toi; /* of the contacts, where there are any; NAN: they are not listed */
    const cscd_guarantee
        *guarantees;      /* per component; NULL: contacts are not listed, and counters are unknown */
    cscd_timings timings; /* check_ms: of the frame at the interval's end */
    cscd_counters counters;
} interval_result;

/* Sums over the intervals so far, and the largest value in an interval. */
typedef struct replay_totals {
    uint32_t intervals, intervals_with_contact, states[INTERVAL_STATES];
    uint32_t frames_checked, frames_crossing, frames_touching; /* touching: and not crossing */
    int32_t first_contact_frame;
    uint32_t contradictions;     /* clean intervals that end in an intersection: contacts that were lost */
    uint32_t intervals_complete; /* every component's contacts are complete, or it is collapsed */
    uint32_t intervals_unlisted; /* their contacts are counted only */
    uint64_t contacts_unlisted;  /* of these intervals */
    cscd_timings time_sum, time_max;
    cscd_counters counter_sum, counter_max; /* of the counters that have a row in methods.h */
} replay_totals;

void totals_add(replay_totals *t, const interval_result *result, const cscd_mesh *mesh);
void totals_print_table(const replay_totals *t, cscd_method method);

/* The facts of a frame. */
typedef enum frame_state { FRAME_UNCHECKED, FRAME_EMBEDDED, FRAME_CROSSING } frame_state;

/* The number of outputs that replay_sink.c lists. */
enum { REPLAY_SINKS = 5 };

/* A replay under way. */
typedef struct replay {
    const replay_options *options;
    const char *name;         /* of a job among many, */
    job_output *job;          /* and its output; NULL: it is none */
    recording_options inputs; /* of the options, with the progress of ours; the recording uses it */
    recording recording;
    ignore_pairs ignored;
    plan_choice plan;
    replay_source source;
    uint32_t first, last;             /* frames; of a shard its own, */
    uint32_t whole_first, whole_last; /* and those of the whole replay */
    append_file results;              /* of a shard */
    shard_series resumed;             /* what it had already */
    shard_series *merged;             /* all shards, to be brought together; NULL: this is something else */
    frame_state start_state, end_state;
    replay_totals totals;
    length_unit unit;
    fail_rules rules;
    answers answers;
    void *sinks[REPLAY_SINKS]; /* the states of the outputs; NULL: not asked for */
    bool sinks_are_open;
    char *summary_text; /* of --json, for the report; NULL until it is whole */
    frame_list contact_frames;
    terminal_progress progress;
} replay;

/* Runs a replay. merged: all shards of it, which have been done; NULL: there are none. name and job: of a job
 * among many, and its output; NULL: it is none. Returns the exit code. */
int replay_run(const replay_options *options, shard_series *merged, const char *name, job_output *job);

/* Prints the answer, the events, the contacts, and what limits them; with --timings more. The replay has
 * ended, be it earlier than expected; without an interval there is the answer alone. */
void replay_print_results(const replay *r);

/* Prints what a person should know beside the results: faults of the mesh, and pairs that are left out. */
void replay_print_remarks(replay *r);

/* Chooses the frames of the shard that the options ask for, and opens its file; what that has already is not
 * found again. Without --shard nothing happens. The recording, what is ignored and the plan are there. */
bool replay_shard_prepare(replay *r, io_error *error);

/* True if the shards that are merged are those of this very recording. */
bool replay_shard_matches(const replay *r, io_error *error);

bool replay_shard_close(replay *r, io_error *error);
