/* The options of `cscd check`, a run with them, and the pairs that it finds, as JSON and as CSV. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/export/export.h"
#include "tool/io/output_file.h"
#include "tool/jobs/jobs.h"

/* ---- options and a run --------------------------------------------------------------------------------- */

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

/* Runs the command on a recording, whose inputs the options have. name, job: of a job among many, which gets
 * the answer; NULL: what is found is printed. Returns the exit code. */
int check_run_on(const check_options *options, const char *name, job_output *job);

/* ---- pairs of triangles, frame by frame ---------------------------------------------------------------- */

typedef struct check_output {
    const char *json_path, *csv_path; /* NULL: not asked for */
    output_file json_file, csv_file;
    json out;
} check_output;

/* On false check_output_abandon is due. */
bool check_output_open(const char *json_path, const char *csv_path, check_output *out, io_error *error);

/* Adds the frame that the answers have taken last. Triangles are numbered as in their model files; the
 * smaller comes first, because welding keeps the order. Duplicates are counted and not listed. */
bool check_output_add(check_output *out, const answers *a, const cscd_intersections *found, io_error *error);

/* The answers are finished. */
bool check_output_close(check_output *out, const answers *a, const length_unit *unit, io_error *error);

/* Nothing was found: older files stay. */
void check_output_abandon(check_output *out);
