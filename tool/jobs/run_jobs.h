/* Runs the jobs of a list, or a shard of them, and keeps their results. */
#pragma once

#include "tool/jobs/job_record.h"
#include "tool/jobs/job_shards.h"
#include "tool/jobs/job_work.h"

typedef struct jobs_request {
    const job_list *list;
    uint64_t hash; /* of the list and of the options that all its jobs share */
    shard_choice shard;
    const char *results_path; /* NULL: none are kept */
    resume_choice resume;
    const char
        *lines_path; /* the same lines in the order of the jobs, once all are there; NULL: not asked for */
    uint32_t thread_count; /* of all jobs together; 0: one per processor */
    double seconds;        /* that a job may take; 0: any time */
    bool quiet;
} jobs_request;

/* Returns the exit code. Nothing has been printed before. */
int run_jobs(const jobs_request *request, const job_kind *kind);
