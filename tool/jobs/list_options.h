/* The options of commands that take lists of jobs. */
#pragma once

#include "tool/common/options.h"
#include "tool/jobs/run_jobs.h"

typedef struct list_options {
    const char *path; /* NULL: there is no list */
    shard_choice shard;
    const char *results_path;
    resume_choice resume;
    double seconds;
} list_options;

/* Their rows. */
extern const option_list list_rows;

/* What to run: the list with these options, and those that were given beside them. Threads, quiet and lines are the caller's. */
jobs_request list_options_request(const list_options *o, const job_list *list, const option_table *table,
                                  const given_options *given);

/* The first of them that was given though there is no list; NULL: none. */
const char *list_option_without_list(const option_table *table, const given_options *given);

/* False, with the reason, if the results would be written over an input. */
bool list_options_are_safe(const list_options *o, const char *const *inputs, size_t input_count,
                           io_error *error);
