/* The files that a list and its jobs have: no two jobs may write the same one, and none the list or its results. */
#pragma once

#include "tool/common/output_path.h"
#include "tool/io/growable.h"
#include "tool/jobs/job_line.h"

/* Does the option of that name say which file the command writes? */
bool option_name_is_output(const option_table *table, const char *name);

typedef struct output_names {
    growable names; /* of output_name */
} output_names;

output_names output_names_begin(void);
void output_names_free(output_names *names);

#define NAME_OF_RUN UINT32_MAX /* as a job: a file of the whole run */

/* Adds a file of the whole run; NULL: none. False if memory is short. */
bool output_names_add_of_run(output_names *names, const char *path);

/* Adds what a job writes. False if memory is short. */
bool output_names_add(output_names *names, const option_table *table, const job_line *line, uint32_t job);

/* Finds a file that two jobs write, or a job (`first`) and the run (`second` is NAME_OF_RUN); false: there is none. */
bool output_names_collide(output_names *names, const char **path, uint32_t *first, uint32_t *second);
