/* Lines of results: the members that every line has, whatever the command (docs/artist/formats.md), the sums of many lines, and
 * reading the results of an earlier run. */
#pragma once

#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/io/output_file.h"

#include <stddef.h>
#include <stdint.h>

/* What a job came to: the worst that was found, in the order crossing, inside, touching, duplicate. As in `check`, what lies in one
 * plane or is folded touches, and duplicates do neither. */
typedef enum job_outcome {
    JOB_CLEAN,
    JOB_CROSSING,
    JOB_TOUCHING, /* triangles touch, or come into contact between two frames */
    JOB_DUPLICATE,
    JOB_INSIDE, /* nothing crosses, but parts share space: they overlap, one is inside the other, or they are copies */
    JOB_FAILED, /* there is no answer, but a reason why not */
    JOB_OUTCOMES
} job_outcome;

enum { JOB_COUNT_MAX = 10 * 1000 * 1000 };

/* As lines of results have it: "crossing". */
const char *job_outcome_name(job_outcome outcome);

typedef struct job_record {
    uint64_t list; /* the hash of the list and of the options that all its jobs share */
    uint32_t jobs; /* in the list */
    uint32_t job;  /* from 0; in the file from 1 */
    job_outcome outcome;
    bool found; /* what --fail-on, --fail-depth or --max-faces asks for */
} job_record;

/* Begins a line with these members. */
void job_record_write(json *line, const job_record *record);

/* Is this how a line of the list begins? The text may end anywhere, or with characters 0, as files do after a power cut. */
bool job_record_begins(const char *text, size_t length, uint64_t list, uint32_t jobs);

/* Reads them back; false for what is no line of results. */
bool job_record_read(const char *text, size_t length, job_record *out);

/* So many jobs of a run. */
typedef struct job_sums {
    uint32_t outcomes[JOB_OUTCOMES], found;
    uint32_t missing; /* no result of them is there */
} job_sums;

void job_sums_add(job_sums *sums, const job_record *record);

/* "1000 meshes: 940 clean, 58 with intersections, 2 failed", behind "Not finished: " if some are missing. one: what one job is. */
void job_sums_print(FILE *out, const job_sums *sums, const char *one, const char *several);

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
