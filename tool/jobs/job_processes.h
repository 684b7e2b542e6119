/* Runs many jobs in processes of their own, so that one that crashes, takes too long or too much memory takes no other with
 * it. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct job_set {
    uint32_t count;
    uint32_t worker_count; /* processes; 1 or more */
    double seconds;        /* that a job may take; 0: any time */
    void *user;

    /* In a worker that is a process of its own, first: drops the files that the calling process alone writes. */
    void (*leave)(void *user);

    /* In a worker, before its first job. False, with the reason: no job runs. */
    bool (*begin)(void *user, io_error *error);

    /* In a worker: does a job, and writes its result. False: the job was given up because the program was interrupted. */
    bool (*run)(void *user, uint32_t job, FILE *result);

    /* In the calling process, each job once, in the order in which they end: the result, or why there is none. False: no
     * further job is to begin, since results cannot be kept. */
    bool (*take)(void *user, uint32_t job, const char *result, size_t size);
    bool (*fail)(void *user, uint32_t job, const char *reason);
} job_set;

/* Runs the jobs, which begin in their order. After an interrupt no further job begins, and what is done is taken. Processes
 * that the system refuses are done without. *done is how many jobs were taken or have failed. The calling process has one thread, and
 * catches interrupts. */
bool jobs_run(const job_set *set, uint32_t *done, io_error *error);
