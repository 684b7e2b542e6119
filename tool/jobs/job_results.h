/* The file that a shard's results are appended to, a line for each job; whatever ends the program, whole lines stay. */
#pragma once

#include "tool/common/append_file.h"
#include "tool/jobs/job_record.h"

typedef struct job_results {
    append_file file; /* of lines */
    unsigned char
        *held; /* per job: what the file said of it when it was opened; 0: nothing, or it is to run again */
} job_results;

/* A job that the file holds; the other members of the record are those of all jobs. */
static inline bool job_results_hold(const job_results *r, uint32_t job) {
    return r->held[job] != 0;
}
void job_results_held(const job_results *r, uint32_t job, job_record *out);

typedef enum resume_choice {
    RESUME_NOTHING, /* the file must be new or empty */
    RESUME_ALL,     /* jobs that the file holds are not run again, */
    RESUME_FAILED   /* but for those that have failed */
} resume_choice;

/* Opens the results of a list and locks them. A last line that is not whole is cut off. On false *out holds nothing to close: the
 * file has results already, or of another list, or is no file of results, or another process has it. */
bool job_results_open(const char *path, resume_choice resume, uint64_t list, uint32_t jobs, job_results *out,
                      io_error *error);

/* Appends a line, which ends with '\n'. After an error the file ends with the line before. */
bool job_results_append(job_results *r, const char *line, size_t size, io_error *error);

/* In a process that only inherited the file: the lock stays with the one that opened it. */
void job_results_drop(job_results *r);

bool job_results_close(job_results *r, io_error *error);
