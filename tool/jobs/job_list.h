/* Lists of jobs, and how they are run: lines, shards, results, workers, and the processes that these are. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/io/output_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* ---- lists --------------------------------------------------------------------------------------------- */

/* A list is a file of JSON Lines (docs/artist/formats.md), or the names of meshes, each a job. A hash tells
 * lists apart. */

/* The size of a job that has none. */
#define NO_JOB_SIZE UINT64_MAX
/* The sizes of as many jobs as a list may have add up without overflow. */
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

/* Reads a line, as docs/artist/formats.md has it. The error says what is wrong, and not where. On false *out
 * holds nothing to free. */
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

/* ---- shards -------------------------------------------------------------------------------------------- */

/* The list alone says which jobs are whose, so that machines need not talk to each other. */

/* i/n of --shard: i from 1 to n. Zeroed: all jobs are one shard. */
typedef struct shard_choice {
    uint32_t index, count;
} shard_choice;

enum { SHARD_COUNT_MAX = 1000 * 1000 };

/* The reader of --shard (options.h); place: shard_choice. */
bool read_shard(const char *text, void *place);

/* The jobs of the shard, ascending, to be freed. Of jobs with a size, the largest goes first to the shard
 * with the least (Graham 1969, largest processing time first; of equals the first); the others go round, job
 * i to shard i modulo n. */
bool job_shard_choose(const job_list *list, shard_choice shard, uint32_t **jobs, uint32_t *count,
                      io_error *error);

/* ---- results ------------------------------------------------------------------------------------------- */

/* Lines of results: the members that every line has, whatever the command (docs/artist/formats.md), the sums
 * of many lines, and the results of an earlier run. */

/* The outcome of a job: the worst that was found, in the order crossing, inside, touching, duplicate. As in
 * `check`, what lies in one plane or is folded touches, and duplicates do neither. */
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

/* Reads them back; false for what is no line of results. */
bool job_record_read(const char *text, size_t length, job_record *out);

/* The numbers of jobs of a run, by outcome. */
typedef struct job_sums {
    uint32_t outcomes[JOB_OUTCOMES], found;
    uint32_t missing; /* no result of them is there */
} job_sums;

void job_sums_add(job_sums *sums, const job_record *record);

/* "1000 meshes: 940 clean, 58 with intersections, 2 failed", behind "Not finished: " if some are missing.
 * one: what one job is. */
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
    RESUME_FAILED   /* those that have failed aside */
} resume_choice;

/* Opens the results of a list and locks them. A last line that is not whole is cut off. On false *out holds
 * nothing to close: the file has results already, or of another list, or is no file of results, or another
 * process has it. */
bool job_results_open(const char *path, resume_choice resume, uint64_t list, uint32_t jobs, job_results *out,
                      io_error *error);

/* Appends a line, which ends with '\n'. After an error the file ends with the line before. */
bool job_results_append(job_results *r, const char *line, size_t size, io_error *error);

/* In a process that only inherited the file: the lock stays with the one that opened it. */
void job_results_drop(job_results *r);

bool job_results_close(job_results *r, io_error *error);

/* ---- what a worker does -------------------------------------------------------------------------------- */

/* A worker runs a job, and packs its answer, or why there is none, into bytes. */

/* The traces of a job that has run, or has failed. */
typedef struct job_output {
    FILE *text;          /* a line for people, without its end */
    json *members;       /* of its line of results, behind those of the record */
    job_outcome outcome; /* JOB_CLEAN at first */
    bool found;          /* what --fail-on and the like ask for */
    bool given_up;       /* because the program was interrupted: there is neither an answer nor a failure */
} job_output;

/* The kind of the jobs of a command, and what they do. */
typedef struct job_kind {
    const char *one, *several; /* what a job is: "mesh", "meshes" */
    const void *user;

    /* False, with the reason or given up: nothing of the output counts. */
    bool (*run)(const void *user, const job_line *job, cscd_context *context, job_output *out,
                io_error *error);

    /* Writes the text and the members of a job that failed. */
    void (*fail)(const void *user, const char *name, const char *reason, job_output *out);
} job_kind;

/* The things that all jobs of a run have in common. */
typedef struct job_work {
    const job_list *list;
    uint64_t hash; /* of the list and of the options that all its jobs share */
    const job_kind *kind;
    cscd_context *context; /* of the worker; the process that only packs failures has none */
} job_work;

/* Runs a job and writes its packed result. False: it was given up. */
bool job_work_run(const job_work *work, uint32_t job, FILE *out);

/* Packs a failure. */
void job_work_fail(const job_work *work, uint32_t job, const char *reason, FILE *out);

/* A packed result, in its parts: the text for people ends with a 0, the line with '\n'. */
typedef struct job_result {
    job_record record;
    const char *text, *line;
    size_t line_size;
} job_result;

job_result job_work_unpack(const char *bytes, size_t size);

/* ---- processes ----------------------------------------------------------------------------------------- */

/* Many jobs run in processes of their own, so that one that crashes, takes too long or too much memory takes
 * no other with it. */

typedef struct job_set {
    uint32_t count;
    uint32_t worker_count; /* processes; 1 or more */
    double seconds;        /* that a job may take; 0: any time */
    void *user;

    /* In a worker that is a process of its own, first: drops the files that the calling process alone
     * writes. */
    void (*leave)(void *user);

    /* In a worker, before its first job. False, with the reason: no job runs. */
    bool (*begin)(void *user, io_error *error);

    /* In a worker: does a job, and writes its result. False: the job was given up because the program was
     * interrupted. */
    bool (*run)(void *user, uint32_t job, FILE *result);

    /* In the calling process, each job once, in the order in which they end: the result, or why there is
     * none. False: no further job is to begin, since results cannot be kept. */
    bool (*take)(void *user, uint32_t job, const char *result, size_t size);
    bool (*fail)(void *user, uint32_t job, const char *reason);
} job_set;

/* Runs the jobs, which begin in their order. After an interrupt no further job begins, and what is done is
 * taken. Processes that the system refuses are done without. *done is how many jobs were taken or have
 * failed. The calling process has one thread, and catches interrupts. */
bool jobs_run(const job_set *set, uint32_t *done, io_error *error);

/* ---- a run --------------------------------------------------------------------------------------------- */

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
