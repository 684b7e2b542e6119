/* What a worker does with a job: runs it, and packs its answer, or why there is none, into bytes. */
#pragma once

#include "cscd/cscd.h"
#include "tool/jobs/job_list.h"
#include "tool/jobs/job_record.h"

/* What a job that has run, or has failed, leaves behind. */
typedef struct job_output {
    FILE *text;          /* a line for people, without its end */
    json *members;       /* of its line of results, behind those of the record */
    job_outcome outcome; /* JOB_CLEAN at first */
    bool found;          /* what --fail-on and the like ask for */
    bool given_up;       /* because the program was interrupted: there is neither an answer nor a failure */
} job_output;

/* What the jobs of a command do. */
typedef struct job_kind {
    const char *one, *several; /* what a job is: "mesh", "meshes" */
    const void *user;

    /* False, with the reason or given up: nothing of the output counts. */
    bool (*run)(const void *user, const job_line *job, cscd_context *context, job_output *out,
                io_error *error);

    /* Writes the text and the members of a job that failed. */
    void (*fail)(const void *user, const char *name, const char *reason, job_output *out);
} job_kind;

/* What all jobs of a run have in common. */
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
