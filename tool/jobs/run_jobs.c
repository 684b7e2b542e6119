/* Runs the jobs of a list, or a shard of them, and keeps their results. */
#include "tool/jobs/jobs.h"

#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/provenance.h"
#include "tool/common/terminal.h"
#include "tool/io/output_file.h"

#include <errno.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- a run --------------------------------------------------------------------------------------------- */

/* A result that waits for those of the jobs before it. */
typedef struct waiting_result {
    char *text, *line;
    bool ended, failed;
} waiting_result;

typedef struct job_run {
    const jobs_request *request;
    job_work work;
    uint32_t *jobs; /* those of the shard that are to run, ascending */
    uint32_t count, worker_count, threads_each;
    uint32_t held; /* others of the shard that are done already */
    waiting_result *waiting;
    uint32_t told; /* the first jobs, as many as have been printed */
    job_results results;
    output_file lines;
    io_error write_error; /* why not all could be written; "": it could */
    job_sums sums;
    terminal_progress progress;
} job_run;

/* ---- in a worker --------------------------------------------------------------------------------------------- */

static bool goes_on(void *user, const char *stage, double fraction) {
    (void)user, (void)stage, (void)fraction;
    return !interrupted();
}

static void leave_caller(void *user) {
    job_run *run = user;
    job_results_drop(&run->results);
}

static bool begin_worker(void *user, io_error *error) {
    job_run *run = user;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = run->threads_each;
    options.progress.report = goes_on;
    const cscd_status status = cscd_context_create(&options, &run->work.context);
    if (status == CSCD_SYSTEM_ERROR)
        return io_fail(error, "the system refused to start %u threads; give --threads a smaller number",
                       run->threads_each * run->worker_count);
    return status == CSCD_OK || io_fail(error, "%s", cscd_status_string(status));
}

static bool run_job(void *user, uint32_t index, FILE *result) {
    const job_run *run = user;
    return job_work_run(&run->work, run->jobs[index], result);
}

/* ---- results ------------------------------------------------------------------------------------------------- */

/* Names may hold line ends and what moves the cursor. */
static void tell_text(const job_run *run, const waiting_result *result) {
    for (char *c = result->text; *c != '\0'; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f) *c = '?';
    if (!run->request->quiet)
        printf("%s\n", result->text);
    else if (result->failed)
        note("%s", result->text);
}

static void write_line(job_run *run, const char *line) {
    if (run->lines.file == NULL || run->write_error.text[0] != '\0') return;
    errno = 0;
    fputs(line, run->lines.file);
    if (!output_file_flush(&run->lines)) io_fail_write(&run->write_error, run->request->lines_path);
}

/* Prints the results that wait for none before them; all: the others too. */
static void tell_waiting(job_run *run, bool all) {
    for (; run->told < run->count && (all || run->waiting[run->told].ended); run->told++) {
        waiting_result *w = &run->waiting[run->told];
        if (w->text != NULL) tell_text(run, w);
        if (w->line != NULL) write_line(run, w->line);
        free(w->text);
        free(w->line);
        *w = (waiting_result){.ended = true};
    }
}

/* Keeps the line at once, and the text until it is its turn. */
static bool keep_result(job_run *run, uint32_t index, const char *bytes, size_t size) {
    const job_result result = job_work_unpack(bytes, size);
    waiting_result *w = &run->waiting[index];
    if (run->results.file.file >= 0 &&
        !job_results_append(&run->results, result.line, result.line_size, &run->write_error))
        return false;
    job_sums_add(&run->sums, &result.record);
    w->ended = true;
    w->failed = result.record.outcome == JOB_FAILED;
    w->text = strdup(result.text);
    w->line = run->lines.file != NULL ? strndup(result.line, result.line_size) : NULL;
    tell_waiting(run, false);
    terminal_progress_update(&run->progress, run->held + run->told, run->held + run->count, "jobs");
    return true;
}

static bool take_failure(void *user, uint32_t index, const char *reason) {
    job_run *run = user;
    char *bytes = NULL;
    size_t size = 0;
    FILE *packed = open_memstream(&bytes, &size);
    if (packed != NULL) job_work_fail(&run->work, run->jobs[index], reason, packed);
    const bool is_packed = packed != NULL && fclose(packed) == 0 && size > 0;
    const bool kept = is_packed ? keep_result(run, index, bytes, size)
                                : io_fail(&run->write_error, "out of memory for the results");
    free(bytes);
    return kept;
}

/* A worker that has no memory for a result sends none. */
static bool take_result(void *user, uint32_t index, const char *bytes, size_t size) {
    return size > 0 ? keep_result(user, index, bytes, size)
                    : take_failure(user, index, "out of memory for its result");
}

/* ---- preparing ------------------------------------------------------------------------------------------------ */

static uint32_t processor_count(void) {
#ifdef CPU_COUNT
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) return (uint32_t)CPU_COUNT(&set);
#endif
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 ? (uint32_t)online : 1;
}

/* Leaves out the jobs that the results hold, and counts them as they are there. */
static void skip_held(job_run *run) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < run->count; i++) {
        job_record held;
        if (!job_results_hold(&run->results, run->jobs[i])) {
            run->jobs[count++] = run->jobs[i];
            continue;
        }
        job_results_held(&run->results, run->jobs[i], &held);
        job_sums_add(&run->sums, &held);
    }
    run->held = run->count - count;
    run->count = count;
}

static bool open_results(job_run *run, io_error *error) {
    const jobs_request *r = run->request;
    if (r->results_path != NULL) {
        if (!job_results_open(r->results_path, r->resume, r->hash, r->list->count, &run->results, error))
            return false;
        skip_held(run);
    }
    return r->lines_path == NULL || output_file_open(r->lines_path, &run->lines) ||
           io_fail_write(error, r->lines_path);
}

/* Jobs have a process each; where there are fewer jobs than threads, each has several. */
static bool prepare_run(job_run *run, io_error *error) {
    const jobs_request *r = run->request;
    const uint32_t threads = r->thread_count > 0 ? r->thread_count : processor_count();
    if (!job_shard_choose(r->list, r->shard, &run->jobs, &run->count, error) || !open_results(run, error))
        return false;
    run->worker_count = threads < run->count ? threads : run->count;
    run->threads_each = run->worker_count > 0 ? threads / run->worker_count : 1;
    run->waiting = calloc((size_t)run->count + 1, sizeof *run->waiting);
    return run->waiting != NULL || io_fail(error, "out of memory for %u jobs", run->count);
}

/* ---- the end ------------------------------------------------------------------------------------------------- */

/* Whole lines that were written stay even if the disk is full. */
static bool close_outputs(job_run *run, io_error *error) {
    bool good = run->write_error.text[0] == '\0' || io_fail(error, "%s", run->write_error.text);
    if (run->lines.file != NULL && !output_file_close(&run->lines, OUTPUT_WHOLE_LINES) && good)
        good = io_fail_write(error, run->request->lines_path);
    return job_results_close(&run->results, good ? error : NULL) && good;
}

static void tell_stop(const job_run *run, uint32_t done) {
    const jobs_request *r = run->request;
    const char *path = r->results_path != NULL ? r->results_path : r->lines_path;
    note("interrupted after %u of %u %s%s%s%s", run->held + done, run->held + run->count,
         run->work.kind->several, path != NULL ? "; what was found is kept in " : "",
         path == NULL                    ? ""
         : output_file_is_standard(path) ? "the standard output"
                                         : path,
         r->results_path != NULL ? ", and --resume goes on with it" : "");
}

static int find_exit_code(const job_run *run) {
    const job_sums *sums = &run->sums;
    const uint32_t failed = sums->outcomes[JOB_FAILED];
    if (interrupted()) return interrupt_exit_code();
    if (failed > 0)
        return fail_input("%u of %u %s could not be checked", failed, run->held + run->count,
                          run->work.kind->several);
    return sums->found > 0 ? EXIT_CONTACT : EXIT_RAN;
}

static int end_run(job_run *run, bool ran, uint32_t done, const io_error *error) {
    io_error close_error = {""};
    tell_waiting(run, true);
    const bool closed = close_outputs(run, &close_error);
    if (interrupted()) run->sums.missing = run->count - done;
    if (!ran) return fail_jobs("%s", error->text);
    if (!run->request->quiet) {
        job_sums_print(stdout, &run->sums, run->work.kind->one, run->work.kind->several);
        if (run->held > 0) note("%u of them were done before", run->held);
    }
    if (!closed) return fail_jobs("%s", close_error.text);
    if (interrupted()) tell_stop(run, done);
    return find_exit_code(run);
}

static int start_run(job_run *run) {
    const job_set set = {.count = run->count,
                         .worker_count = run->worker_count,
                         .seconds = run->request->seconds,
                         .user = run,
                         .leave = leave_caller,
                         .begin = begin_worker,
                         .run = run_job,
                         .take = take_result,
                         .fail = take_failure};
    io_error error = {""};
    uint32_t done = 0;
    terminal_progress_begin(&run->progress, run->request->quiet || isatty(STDOUT_FILENO));
    const bool ran = run->count == 0 || jobs_run(&set, &done, &error);
    terminal_progress_end(&run->progress);
    return end_run(run, ran, done, &error);
}

int run_jobs(const jobs_request *request, const job_kind *kind) {
    job_run run = {.request = request,
                   .work = {.list = request->list, .hash = request->hash, .kind = kind},
                   .results = {.file = {.file = -1}}};
    io_error error = {""};
    interrupt_catch();
    const bool ready = prepare_run(&run, &error);
    int code = ready ? start_run(&run) : fail_jobs("%s", error.text);
    job_results_drop(&run.results);
    free(run.jobs);
    free(run.waiting);
    return code;
}

/* ---- options of commands that take lists --------------------------------------------------------------- */

static bool read_resume(const char *text, void *place) {
    if (text != NULL && strcmp(text, "failed") != 0) return false;
    *(resume_choice *)place = text == NULL ? RESUME_ALL : RESUME_FAILED;
    return true;
}

static const option_row rows[] = {
    {"list", "JOBS.jsonl", read_text, offsetof(list_options, path),
     "many recordings, a job a line: {\"model\": ..., \"frames\": ..., \"options\": ..., \"outputs\": ...}; each has its "
     "answer in a line, and one that fails stops no other"},
    {"shard", "I/N", read_shard, offsetof(list_options, shard),
     "only the I-th of N shards, I from 1, of the list's jobs, or of the intervals of one recording (replay): each machine takes "
     "another, and cscd merge brings them together"},
    {"results", "OUT", read_text, offsetof(list_options, results_path),
     "append a line of JSON for each job as soon as it is done, or a record of each interval; each shard has a file of its own"},
    {"resume", "[=failed]", read_resume, offsetof(list_options, resume),
     "go on where the file of results ends, whatever stopped the run; =failed: run jobs again that have failed"},
    {"job-timeout", "S", read_seconds, offsetof(list_options, seconds),
     "a job that takes longer than S seconds has failed (default: any time)"},
};

const option_list list_rows = {"Many jobs:", rows, sizeof rows / sizeof *rows};

static const char *const names[] = {"list", "shard", "results", "resume", "job-timeout"};
enum { NAMES = sizeof names / sizeof *names };

/* The hash of a list and of the options that were given beside it, those left out that change no result. */
static uint64_t hash_work(const job_list *list, const option_table *table, const given_options *given) {
    static const char *const harmless[] = {"list", "shard",   "results", "resume", "job-timeout",
                                           "each", "threads", "quiet",   "json"};
    const uint64_t options = option_hash_beside(table, given, harmless, sizeof harmless / sizeof *harmless);
    const uint64_t hash = provenance_hash(list->hash, table->command, strlen(table->command) + 1);
    return provenance_hash_numbers(hash, &options, 1, sizeof options);
}

jobs_request list_options_request(const list_options *o, const job_list *list, const option_table *table,
                                  const given_options *given) {
    return (jobs_request){.list = list,
                          .hash = hash_work(list, table, given),
                          .shard = o->shard,
                          .results_path = o->results_path,
                          .resume = o->resume,
                          .seconds = o->seconds};
}

const char *list_option_without_list(const option_table *table, const given_options *given) {
    for (int i = 1; i < NAMES; i++)
        if (option_given(table, given, names[i])) return names[i];
    return NULL;
}

bool list_options_are_safe(const list_options *o, const char *const *inputs, size_t input_count,
                           io_error *error) {
    const char *others[] = {o->path};
    if (output_file_is_standard(o->results_path))
        return io_fail(error, "-: results are kept in a file, which --resume goes on with; name one");
    return output_path_is_safe(o->results_path, inputs, input_count, error) &&
           output_path_is_safe(o->results_path, others, 1, error) &&
           output_path_fits(o->results_path, ".jsonl", error);
}
