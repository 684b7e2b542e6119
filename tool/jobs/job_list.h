/* A list of jobs: a file of JSON Lines (docs/artist/formats.md), or the names of meshes, each a job. */
#pragma once

#include "tool/jobs/job_line.h"
#include "tool/jobs/job_record.h"

#include <stdbool.h>

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
