/* Jobs: lists of them, as commands take them, recordings and meshes that are jobs, and results that are
 * merged. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/options.h"
#include "tool/jobs/job_list.h"

/* ---- options of commands that take lists --------------------------------------------------------------- */

typedef struct list_options {
    const char *path; /* NULL: there is no list */
    shard_choice shard;
    const char *results_path;
    resume_choice resume;
    double seconds;
} list_options;

/* Their rows. */
extern const option_list list_rows;

/* A request to run the list with these options, and those that were given beside them. Threads, quiet and
 * lines are the caller's. */
jobs_request list_options_request(const list_options *o, const job_list *list, const option_table *table,
                                  const given_options *given);

/* The first of them that was given though there is no list; NULL: none. */
const char *list_option_without_list(const option_table *table, const given_options *given);

/* False, with the reason, if the results would be written over an input. */
bool list_options_are_safe(const list_options *o, const char *const *inputs, size_t input_count,
                           io_error *error);

/* ---- recordings ---------------------------------------------------------------------------------------- */

/* `check --list` and `replay --list`: each job of a list is a command of its own. */

typedef struct list_command {
    const option_table *table;
    const void *options; /* of the command line; a job begins with a copy, and adds its own */
    size_t options_size;
    const given_options *given;
    const list_options *list;
    uint32_t thread_count;
    bool quiet;

    /* Runs the command with these options and inputs, and writes its answer. Returns the exit code; failures
     * are kept (command.h). */
    int (*run)(void *options, given_options *given, const char *name, cscd_context *context, job_output *out);
} list_command;

/* Returns the exit code. */
int run_listed_recordings(const list_command *command);

/* The answers are finished. */
void recording_answer_write(const char *name, const answers *a, const length_unit *unit,
                            const fail_rules *rules, job_output *out);

/* The same of one that failed: all members but these two are null. */
void recording_answer_fail(const char *name, const char *reason, job_output *out);

/* ---- meshes -------------------------------------------------------------------------------------------- */

/* One mesh among many: how it is read and checked, what was found in all frames that its file holds, and its
 * line of results. */

typedef struct mesh_job {
    const char *path;
    const recording_options *source; /* how it is read: welding, frames a second, which animation, rest */
    const ignore_options *ignored;   /* pairs of parts that are left out */
    const answer_options *answers;   /* rules, unit, whether depths are looked for */
} mesh_job;

typedef struct mesh_answer {
    bool checked;                          /* else the error says why not, and all else is 0 */
    char *error;                           /* NULL: no memory was left for it */
    uint32_t triangle_count, vertex_count; /* welded, if that was asked for */
    uint32_t frame_count;                  /* that were checked: 1, or those of the animation */
    size_t crossing, coplanar, folded, duplicate,
        touching;            /* pairs of triangles of each kind, of all frames together */
    uint32_t crossing_faces; /* triangles in a pair that crosses, in the frame that has the most, */
    double crossing_share;   /* and that share of all */
    double depth;            /* the greatest; 0: none is known */
    job_outcome outcome;
    bool found;     /* what the rules ask for */
    char *sentence; /* as `check` begins */
    uint32_t zero_area_triangles;
    mesh_repairs repairs;
    char *unread; /* as in mesh_file */
    double read_ms, check_ms;
} mesh_answer;

/* Reads a mesh and finds what intersects in it. False: the search was interrupted, and *out holds
 * nothing to free. A mesh that cannot be read or checked is an answer, too: its error says why. */
bool mesh_job_run(const mesh_job *job, cscd_context *context, mesh_answer *out);
typedef struct mesh_kind_options {
    const recording_options *source; /* how meshes are read */
    const ignore_options *ignored;   /* pairs of parts */
    const answer_options *answers;   /* rules, unit, depths */
    bool reproducible;               /* lines come without times */
} mesh_kind_options;

/* The options outlive the kind. */
job_kind mesh_kind_of(const mesh_kind_options *options);

/* ---- results of all shards ----------------------------------------------------------------------------- */

/* The place of a job's line. */
typedef struct merged_line {
    uint64_t offset;
    uint32_t file, length; /* with its '\n'; 0: there is none */
    job_record record;
} merged_line;

/* The lines that the results must have. */
typedef enum job_merge_rule {
    MERGE_WHOLE,        /* a line of each job */
    MERGE_WHAT_IS_THERE /* jobs may be missing, and a last line torn: its shard may be running */
} job_merge_rule;

/* A line is some hundred bytes long: so the memory goes with the lines that are there, and not with the jobs
 * that they speak of. */
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

/* Reads the files. False: a job is missing or there twice, a file is of another list, or a line is none
 * of results; the error names file, line and job. *out holds nothing to free then. The paths outlive the
 * merge. */
bool job_merge_read(const char *const *paths, size_t count, job_merge_rule rule, job_merge *out,
                    io_error *error);

/* Takes a line, without its end; false, with the error, ends the visit. Of a job that is missing the line is
 * NULL, and the record says which job it is and nothing else. */
typedef bool job_line_taker(void *user, const char *line, size_t length, const job_record *record,
                            io_error *error);

/* Hands out all lines in the order of the jobs; an interrupt ends the visit, too. */
bool job_merge_visit(const job_merge *merge, job_line_taker *take, void *user, io_error *error);

void job_merge_free(job_merge *merge);

/* A job fails if it found what --fail-on and the like ask for, and is an error if it has failed itself.
 * suite: what all of them are called. */
void job_junit_begin(FILE *out, const char *suite, const job_sums *sums);

/* Adds a job by its line of results; NULL: the job is missing, which is an error. False if memory is
 * short. */
bool job_junit_add(FILE *out, const char *line, size_t length, const job_record *record);

void job_junit_end(FILE *out);

/* Numbers that a line does not have are NaN, texts are "". */
typedef struct job_row {
    const char *name;
    const char *answer; /* the sentence of a job, or why it has failed */
    const char *report; /* the path of its page, from the folder where the job ran */
    double frames, crossing_frames, events, depth, crossing_pairs;
    double seconds;
    void *memory; /* of the texts */
} job_row;

/* False: memory is short, or this is no JSON, and *out holds nothing to free. */
bool job_row_read(const char *line, size_t length, job_row *out);

void job_row_free(job_row *row);
