/* `cscd check --each`: checks many different meshes, each alone, and says a line of each. */
#include "src/tool/each/check_each.h"

#include "src/io/output_file.h"
#include "src/tool/common/command.h"
#include "src/tool/common/output_path.h"
#include "src/tool/common/terminal.h"
#include "src/tool/each/answer_lines.h"
#include "src/tool/each/job_runner.h"

#include <errno.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct each_run {
    const each_request *request;
    const char *const *paths;
    uint32_t count, worker_count;
    cscd_context **contexts; /* one for each worker, since two threads may not use the same */
    mesh_answer *answers;
    output_file file; /* its file is NULL when not asked for */
    int write_error;  /* why it could not be written; 0: it could */
    answer_sums sums;
    terminal_progress progress;
    uint32_t told;
} each_run;

/* ---- threads ----------------------------------------------------------------------------------------- */

static uint32_t processor_count(void) {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) return (uint32_t)CPU_COUNT(&set);
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 ? (uint32_t)online : 1;
}

static bool goes_on(void *user, const char *stage, double fraction) {
    (void)user, (void)stage, (void)fraction;
    return !interrupted();
}

/* Threads work on different meshes. Where there are more threads than meshes, each mesh has several. */
static bool create_contexts(each_run *run, io_error *error) {
    const uint32_t asked = run->request->thread_count;
    const uint32_t threads = asked > 0 ? asked : processor_count();
    cscd_context_options options = cscd_context_defaults();
    run->worker_count = threads < run->count ? threads : run->count;
    options.thread_count = threads / run->worker_count;
    options.progress.report = goes_on;
    run->contexts = calloc(run->worker_count, sizeof *run->contexts);
    run->answers = calloc(run->count, sizeof *run->answers);
    if (run->contexts == NULL || run->answers == NULL)
        return io_fail(error, "out of memory for %u meshes", run->count);
    for (uint32_t i = 0; i < run->worker_count; i++) {
        cscd_status status = cscd_context_create(&options, &run->contexts[i]);
        if (status == CSCD_SYSTEM_ERROR)
            return io_fail(error, "the system refused to start %u threads; give --threads a smaller number",
                           threads);
        if (status != CSCD_OK) return io_fail(error, "%s", cscd_status_string(status));
    }
    return true;
}

/* ---- jobs -------------------------------------------------------------------------------------------- */

static bool run_job(void *user, uint32_t worker, uint32_t job) {
    each_run *run = user;
    const mesh_job mesh = {
        .path = run->paths[job], .weld = run->request->weld, .ignored = &run->request->ignored};
    return mesh_job_run(&mesh, run->contexts[worker], &run->answers[job]);
}

static void tell_answer(void *user, uint32_t job) {
    each_run *run = user;
    mesh_answer *answer = &run->answers[job];
    answer_sums_add(&run->sums, answer);
    if (!run->request->quiet)
        answer_print(stdout, run->paths[job], answer);
    else if (!answer->checked)
        note("%s", mesh_answer_reason(answer));
    if (run->file.file != NULL && run->write_error == 0) {
        errno = 0;
        answer_write_json(run->file.file, run->paths[job], answer);
        if (!output_file_flush(&run->file)) run->write_error = errno != 0 ? errno : EIO;
    }
    mesh_answer_free(answer);
    terminal_progress_update(&run->progress, ++run->told, run->count, "check");
}

/* ---- the command ------------------------------------------------------------------------------------- */

static bool open_lines(each_run *run, io_error *error) {
    const char *path = run->request->json_path;
    return path == NULL || output_file_open(path, &run->file) ||
           io_fail(error, "%s: cannot write: %s", path, strerror(errno));
}

/* What was written of whole lines stays even if the disk is full. */
static bool close_lines(each_run *run, io_error *error) {
    if (run->file.file == NULL) return true;
    if (!output_file_close(&run->file, OUTPUT_WHOLE_LINES) && run->write_error == 0) run->write_error = errno;
    return run->write_error == 0 ||
           io_fail(error, "%s: cannot write: %s", run->request->json_path, strerror(run->write_error));
}

static void tell_stop(const each_run *run, uint32_t done) {
    const char *path = run->request->json_path;
    note("interrupted after %u of %u meshes%s%s", done, run->count,
         path != NULL ? "; what was found is kept in " : "",
         path == NULL                    ? ""
         : output_file_is_standard(path) ? "the standard output"
                                         : path);
}

static int find_exit_code(const each_run *run) {
    const answer_sums *sums = &run->sums;
    if (interrupted()) return interrupt_exit_code();
    if (sums->failed > 0) return fail_input("%u of %u meshes could not be checked", sums->failed, run->count);
    const each_request *request = run->request;
    const bool crossing = request->fail_on_crossing || request->fail_on_touching;
    const bool found = (crossing && sums->crossing > 0) || (request->fail_on_touching && sums->touching > 0);
    return found ? EXIT_CONTACT : EXIT_RAN;
}

static int run_jobs(each_run *run) {
    const job_set set = {.count = run->count,
                         .worker_count = run->worker_count,
                         .user = run,
                         .run = run_job,
                         .pass_on = tell_answer};
    const bool quiet = run->request->quiet;
    io_error error = {""}, close_error = {""};
    uint32_t done = 0;
    terminal_progress_begin(&run->progress, quiet || isatty(STDOUT_FILENO));
    const bool ran = jobs_run(&set, &done, &error), closed = close_lines(run, &close_error);
    terminal_progress_end(&run->progress);
    if (!ran) return fail_input("%s", error.text);
    if (!quiet) answer_sums_print(stdout, &run->sums);
    if (!closed) return fail_input("%s", close_error.text);
    if (interrupted()) tell_stop(run, done);
    return find_exit_code(run);
}

static int start_jobs(each_run *run) {
    io_error error = {""};
    interrupt_catch();
    const bool ready = create_contexts(run, &error) && open_lines(run, &error);
    const int code = ready ? run_jobs(run) : fail_input("%s", error.text);
    for (uint32_t i = 0; run->contexts != NULL && i < run->worker_count; i++)
        cscd_context_destroy(run->contexts[i]);
    free(run->contexts);
    free(run->answers);
    return code;
}

int check_each(const option_table *table, const given_options *given, const each_request *request) {
    io_error error;
    static const char *const own[] = {
        "each", "json", "weld", "ignore-parts", "only", "threads", "fail-on", "fail-on-contact", "quiet"};
    const char *foreign = option_given_beside(table, given, own, sizeof own / sizeof *own);
    if (foreign != NULL)
        return fail_usage("check", "--each checks each mesh alone, and --%s says nothing about that",
                          foreign);
    if (given->input_count == 0) return fail_usage("check", "--each: no meshes given");
    if (!output_path_is_safe(request->json_path, given->inputs, given->input_count, &error) ||
        (!output_path_fits(request->json_path, ".json", NULL) &&
         !output_path_fits(request->json_path, ".jsonl", &error)))
        return fail_usage("check", "--json %s", error.text);
    each_run run = {.request = request, .paths = given->inputs, .count = (uint32_t)given->input_count};
    return start_jobs(&run);
}
