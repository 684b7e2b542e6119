/* The files that the jobs of a list write: no two jobs may write the same one. */
#pragma once

#include "src/io/growable.h"
#include "src/tool/jobs/job_line.h"

/* Files that a command writes, by the names of its options; ends with NULL. */
extern const char *const output_options[];
bool option_is_output(const char *option);

typedef struct output_names {
    growable names; /* of output_name */
} output_names;

output_names output_names_begin(void);
void output_names_free(output_names *names);

/* Adds what a job writes. False if memory is short. */
bool output_names_add(output_names *names, const job_line *line, uint32_t job);

/* Finds a file that two jobs write; false: there is none. */
bool output_names_collide(output_names *names, const char **path, uint32_t *first, uint32_t *second);
