/* Lists of jobs: a file of JSON Lines (docs/artist/formats.md), or the names of meshes, each a job; the lines, and the hash that
 * tells lists apart. */
#pragma once

#include "tool/io/io.h"
#include "tool/jobs/job_record.h"

#include <stdbool.h>
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

typedef struct listed_job {
    const char *text; /* its line, or the name, which ends with a 0 then */
    size_t length;
    uint64_t size; /* NO_JOB_SIZE: none is given */
    size_t line;   /* of the file, from 1 */
} listed_job;

typedef struct job_list {
    const char *path; /* NULL: a list of names */
    char *text;
    listed_job *jobs;
    uint32_t count;
    uint64_t hash; /* of its text */
} job_list;

/* Reads a file, and every line of it; blank lines hold no job. On false *out holds nothing to free. */
bool job_list_read(const char *path, job_list *out, io_error *error);

/* The names outlive the list. */
bool job_list_of_names(const char *const *names, size_t count, job_list *out, io_error *error);

void job_list_free(job_list *list); /* a zeroed one is fine */

/* Reads the line of a job; of a name, the mesh alone. */
bool job_list_line(const job_list *list, uint32_t job, job_line *out, io_error *error);

/* Adds what is wrong in a job's line to where that is: "jobs.jsonl:17: ...". */
bool job_list_fail(const job_list *list, uint32_t job, const char *reason, io_error *error);
