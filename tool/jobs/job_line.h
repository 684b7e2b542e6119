/* A line of a list of jobs: the inputs of a job, and its options beside those of the command line. */
#pragma once

#include "tool/io/io_error.h"

#include <stddef.h>
#include <stdint.h>

/* The size of a job that has none. */
#define NO_JOB_SIZE UINT64_MAX
/* So many jobs as a list may have add up without overflow. */
#define JOB_SIZE_MAX UINT64_C(1000000000000)

typedef struct job_option {
    const char *name;  /* without its dashes */
    const char *value; /* NULL: none, as of a switch */
} job_option;

typedef struct job_line {
    const char *name;    /* what results call it: that of the line, else the model */
    const char **inputs; /* the model and its frames */
    size_t input_count;
    job_option *options;
    size_t option_count;
    uint64_t size; /* what it costs, in any measure */
    void *memory;  /* of these texts */
} job_line;

/* Reads a line, as docs/artist/formats.md has it. The error says what is wrong, and not where. On false *out holds nothing to free. */
bool job_line_read(const char *text, size_t length, job_line *out, io_error *error);

void job_line_free(job_line *line); /* a zeroed one is fine */
