/* A replay under way: what it reads, how far it is, and what it has found. */
#pragma once

#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/common/plan_source.h"
#include "tool/common/terminal.h"
#include "tool/replay/replay_options.h"
#include "tool/replay/replay_source.h"
#include "tool/replay/table.h"

/* What is known of a frame. */
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

/* Runs a replay. merged: all shards of it, which have been done; NULL: there are none. name and job: of a job among many, and its
 * output; NULL: it is none. Returns the exit code. */
int replay_run(const replay_options *options, shard_series *merged, const char *name, job_output *job);
