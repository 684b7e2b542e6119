/* The JSON summary of a replay, written interval by interval. */
#pragma once

#include "tool/answers/answer_files.h"
#include "tool/replay/table.h"

typedef struct summary_writer summary_writer;

/* Opens a summary. path NULL: there is no file. keep_text: summary_close can return the whole text. times: intervals have them. */
bool summary_open(const char *path, bool keep_text, bool times, const cscd_mesh *mesh, summary_writer **out,
                  io_error *error);
/* Writes an interval, which is handed to the system at once. */
bool summary_add_interval(summary_writer *w, const interval_result *result, io_error *error);

typedef struct summary_ending {
    const replay_totals *totals;
    const recording *recording;
    const plan_choice *plan;
    const answers *answers; /* finished, as far as they came */
    const length_unit *unit;
    const char *mode;
    cscd_volume volume;
    bool reproducible; /* without times, dates, the machine and the command line */
    int argument_count;
    char **arguments;
    double min_separation;
} summary_ending;

/* Writes the frames, the events, the summary and the provenance, and closes. text NULL, or with keep_text: all that was
 * written, to be freed, also when the file could not be; NULL when there was no memory for it. */
bool summary_close(summary_writer *w, const summary_ending *ending, char **text, io_error *error);
