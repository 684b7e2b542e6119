/* Results of jobs as a JUnit file, for continuous integration: a test case for each job. */
#pragma once

#include "tool/jobs/job_record.h"

/* A job fails if it found what --fail-on and the like ask for, and is an error if it has failed itself. suite: what all of them are
 * called. */
void job_junit_begin(FILE *out, const char *suite, const job_sums *sums);

/* Adds a job by its line of results; NULL: the job is missing, which is an error. False if memory is short. */
bool job_junit_add(FILE *out, const char *line, size_t length, const job_record *record);

void job_junit_end(FILE *out);
