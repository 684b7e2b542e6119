/* Brings the results of all shards together: finds the line of each job, copies them in order, and writes them as JUnit. */
#pragma once

#include "tool/jobs/job_record.h"

/* Where a job's line stands. */
typedef struct merged_line {
    uint64_t offset;
    uint32_t file, length; /* with its '\n'; 0: there is none */
    job_record record;
} merged_line;

/* What the results must have. */
typedef enum job_merge_rule {
    MERGE_WHOLE,        /* a line of each job */
    MERGE_WHAT_IS_THERE /* jobs may be missing, and a last line torn: its shard may be running */
} job_merge_rule;

/* A line is some hundred bytes long: so the memory goes with the lines that are there, and not with the jobs that they speak of. */
enum { MERGE_NAMED_SIZE = 256, MERGE_PAGE = 64 };

typedef struct job_merge {
    const char *const *paths;
    size_t path_count;
    job_merge_rule rule;
    merged_line **pages;  /* the lines, MERGE_PAGE jobs each; NULL: there is none of these */
    uint32_t jobs, first; /* first: the file that the first line was in */
    uint64_t list;
    job_sums sums;
    char missing[MERGE_NAMED_SIZE]; /* "3, 6, 9 to 21 and others"; "": none */
} job_merge;

/* Reads the files. False: a job is missing or there twice, a file is of another list, or a line is none of results; the error names
 * file, line and job. *out holds nothing to free then. The paths outlive the merge. */
bool job_merge_read(const char *const *paths, size_t count, job_merge_rule rule, job_merge *out,
                    io_error *error);

/* Takes a line, without its end; false, with the error, ends the visit. Of a job that is missing the line is NULL, and the record
 * says which job it is and nothing else. */
typedef bool job_line_taker(void *user, const char *line, size_t length, const job_record *record,
                            io_error *error);

/* Hands out all lines in the order of the jobs; an interrupt ends the visit, too. */
bool job_merge_visit(const job_merge *merge, job_line_taker *take, void *user, io_error *error);

void job_merge_free(job_merge *merge);

/* A job fails if it found what --fail-on and the like ask for, and is an error if it has failed itself. suite: what all of them are
 * called. */
void job_junit_begin(FILE *out, const char *suite, const job_sums *sums);

/* Adds a job by its line of results; NULL: the job is missing, which is an error. False if memory is short. */
bool job_junit_add(FILE *out, const char *line, size_t length, const job_record *record);

void job_junit_end(FILE *out);
