/* `check --list` and `replay --list`: each job of a list is a command of its own. */
#pragma once

#include "tool/jobs/list_options.h"

typedef struct list_command {
    const option_table *table;
    const void *options; /* of the command line; a job begins with a copy, and adds its own */
    size_t options_size;
    const given_options *given;
    const list_options *list;
    uint32_t thread_count;
    bool quiet;

    /* Runs the command with these options and inputs, and writes its answer. Returns the exit code; failures are
     * kept (command.h). */
    int (*run)(void *options, given_options *given, const char *name, cscd_context *context, job_output *out);
} list_command;

/* Returns the exit code. */
int run_listed_recordings(const list_command *command);
