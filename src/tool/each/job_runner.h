/* Runs many jobs on several threads, and passes on what they found in the order of the jobs. */
#pragma once

#include "src/io/io_error.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct job_set {
    uint32_t count;
    uint32_t worker_count; /* threads, the calling one included; 1 or more */
    void *user;

    /* Does a job. worker: below worker_count; no two jobs run at once with the same one. False: the job was given up
     * because the program was interrupted, and has no result. */
    bool (*run)(void *user, uint32_t worker, uint32_t job);

    /* Takes the result of a job that was done: in the order of the jobs, and never two at once, whatever thread calls. */
    void (*pass_on)(void *user, uint32_t job);
} job_set;

/* Runs the jobs from 0 on. After an interrupt no further job begins, and the results of all that were done are passed on.
 * Threads that the system refuses are done without. *done is how many jobs have a result. False only if memory is short,
 * and then nothing has run. */
bool jobs_run(const job_set *set, uint32_t *done, io_error *error);
