/* The options of `cscd check`, and a run with them. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/export/export.h"
#include "tool/jobs/jobs.h"

typedef struct check_options {
    recording_options source;
    frame_range frames;
    const char *json_path, *csv_path;
    ignore_options ignored;
    answer_options answers;
    export_request exports;
    list_options list;
    bool each, reproducible, quiet;
} check_options;

extern const option_table check_table;

/* Runs the command on a recording, whose inputs the options have. name, job: of a job among many, which gets the answer; NULL: what is
 * found is printed. Returns the exit code. */
int check_run_on(const check_options *options, const char *name, job_output *job);
