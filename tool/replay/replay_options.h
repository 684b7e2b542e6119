/* The options of `cscd replay`. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/export/export.h"
#include "tool/jobs/jobs.h"
#include "tool/report/report.h"

typedef struct replay_options {
    recording_options source;
    cscd_method method;
    uint32_t k;    /* of method KMEANS; 0: not given */
    uint64_t ours; /* of the published methods */
    cscd_mode mode;
    cscd_start start;
    cscd_volume volume;
    frame_range frames;
    double min_separation;
    bool no_check, quiet;
    bool reproducible; /* nothing is written of times, dates, the machine and the command line */
    uint64_t hash;     /* of the options that shards of one replay have in common */
    answer_options answers;
    export_request exports;
    ignore_options ignored;
    const char *plan_path, *contacts_path, *json_path; /* NULL: not given */
    report_request report;
    list_options list;
    int argument_count; /* the command line, for the provenance */
    char **arguments;
} replay_options;

extern const option_table replay_table;

/* Reads the command line. False: *code is the exit code to end with (0 after --help). */
bool replay_options_read(int argument_count, char **arguments, replay_options *out, given_options *given,
                         int *code);

/* Takes the inputs, and returns the exit code for options that contradict each other or the inputs. */
int replay_options_finish(replay_options *o, given_options *given);
