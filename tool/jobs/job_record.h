/* The members that every line of results has, whatever the command: docs/artist/formats.md. */
#pragma once

#include "tool/io/io_error.h"
#include "tool/io/json.h"

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
