/* `cscd report` of results of jobs: the page of a night, of which jobs may be missing. */
#include "tool/tool.h"

#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/provenance.h"
#include "tool/common/terminal.h"
#include "tool/io/io.h"
#include "tool/io/output_file.h"
#include "tool/io/text_encoding.h"
#include "tool/jobs/jobs.h"
#include "tool/report/report.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- what is given ------------------------------------------------------------------------------------- */

enum { FIRST_LINE_MAX = 1 << 20 };

/* A pipe is not read: what is taken from it is gone. */
static bool begins_with_result(const char *path) {
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) return false;
    FILE *file = fopen(path, "rb");
    char *text = file != NULL ? malloc(FIRST_LINE_MAX) : NULL;
    const size_t size = text != NULL ? fread(text, 1, FIRST_LINE_MAX, file) : 0;
    const char *end = size > 0 ? memchr(text, '\n', size) : NULL;
    job_record record;
    const size_t mark = text_mark_size(text, size);
    const bool is_result = end != NULL && job_record_read(text + mark, (size_t)(end - text) - mark, &record);
    free(text);
    if (file != NULL) fclose(file);
    return is_result;
}

bool jobs_report_takes(const char *path) {
    return path_has_extension(path, ".jsonl") || begins_with_result(path);
}

/* ---- the page ------------------------------------------------------------------------------------------ */

typedef struct night_files {
    const jobs_report_request *request;
    jobs_page *page;
    output_file junit; /* its file is NULL when not asked for */
} night_files;

static bool add_missing(jobs_page *page, const job_record *record, io_error *error) {
    char name[32];
    snprintf(name, sizeof name, "job %u", record->job + 1);
    jobs_page_row row = {.outcome = JOB_OUTCOMES, .name = name, .answer = "", .report = ""};
    for (int i = 0; i < JOBS_PAGE_NUMBERS; i++) row.numbers[i] = NAN;
    return jobs_page_add(page, &row, error);
}

/* Reasons begin with the file that they are about, which often is the name. */
static const char *without_name(const char *answer, const char *name) {
    const size_t length = strlen(name);
    const bool named = length > 0 && strncmp(answer, name, length) == 0 && answer[length] == ':';
    return named ? answer + length + 1 + strspn(answer + length + 1, " ") : answer;
}

static bool add_row(jobs_page *page, const char *line, size_t length, const job_record *record,
                    io_error *error) {
    job_row row;
    if (!job_row_read(line, length, &row)) return io_fail(error, "out of memory");
    const jobs_page_row shown = {.outcome = (uint8_t)record->outcome,
                                 .found = record->found,
                                 .name = row.name,
                                 .answer = without_name(row.answer, row.name),
                                 .report = row.report,
                                 .numbers = {[JOBS_PAGE_CROSSING_FRAMES] = row.crossing_frames,
                                             [JOBS_PAGE_FRAMES] = row.frames,
                                             [JOBS_PAGE_EVENTS] = row.events,
                                             [JOBS_PAGE_DEPTH] = row.depth,
                                             [JOBS_PAGE_PAIRS] = row.crossing_pairs,
                                             [JOBS_PAGE_SECONDS] = row.seconds}};
    const bool added = jobs_page_add(page, &shown, error);
    job_row_free(&row);
    return added;
}

/* Looks after each line: what follows changes errno. */
static bool still_writes(const char *path, output_file *file, io_error *error) {
    return file->file == NULL || output_file_writes(file) || io_fail_write(error, path);
}

static bool take_line(void *user, const char *line, size_t length, const job_record *record,
                      io_error *error) {
    night_files *files = user;
    if (files->junit.file != NULL && !job_junit_add(files->junit.file, line, length, record))
        return io_fail(error, "out of memory");
    if (!still_writes(files->request->junit_path, &files->junit, error)) return false;
    return line != NULL ? add_row(files->page, line, length, record, error)
                        : add_missing(files->page, record, error);
}

static bool create_page(const jobs_report_request *r, const job_merge *merge, const char *generator,
                        const char *const *outcomes, jobs_page **out, io_error *error) {
    const jobs_page_options options = {.path = r->output_path,
                                       .title = r->title != NULL ? r->title : "Jobs",
                                       .generator = generator,
                                       .outcomes = outcomes,
                                       .missing = merge->missing,
                                       .list = merge->list};
    return jobs_page_create(&options, out, error);
}

static bool open_junit(const char *path, output_file *file, io_error *error) {
    return path == NULL || output_file_open(path, file) || io_fail_write(error, path);
}

static bool close_junit(const char *path, output_file *file, bool whole, io_error *error) {
    if (file->file == NULL) return true;
    return output_file_close(file, whole ? OUTPUT_WHOLE : OUTPUT_ABANDONED) || !whole ||
           io_fail_write(error, path);
}

static bool write_files(const jobs_report_request *r, const job_merge *merge, io_error *error) {
    char generator[PROVENANCE_GENERATOR_SIZE];
    const char *outcomes[JOB_OUTCOMES + 2] = {[JOB_OUTCOMES] = "missing"};
    night_files files = {.request = r};
    for (int i = 0; i < JOB_OUTCOMES; i++) outcomes[i] = job_outcome_name((job_outcome)i);
    provenance_generator(generator);
    bool good = create_page(r, merge, generator, outcomes, &files.page, error) &&
                open_junit(r->junit_path, &files.junit, error);
    errno = 0;
    if (good && files.junit.file != NULL) job_junit_begin(files.junit.file, merge->paths[0], &merge->sums);
    good = good && job_merge_visit(merge, take_line, &files, error);
    if (good && files.junit.file != NULL) job_junit_end(files.junit.file);
    const bool whole = good && !interrupted();
    good = close_junit(r->junit_path, &files.junit, whole, good ? error : NULL) && good;
    if (good && whole) good = jobs_page_write(files.page, error);
    jobs_page_destroy(files.page);
    return good;
}

/* ---- the end ------------------------------------------------------------------------------------------- */

static int end_report(const jobs_report_request *r, const job_merge *merge) {
    const job_sums *sums = &merge->sums;
    const uint32_t failed = sums->outcomes[JOB_FAILED];
    if (interrupted()) {
        note("interrupted; nothing was written");
        return interrupt_exit_code();
    }
    if (!r->quiet) {
        job_sums_print(stdout, sums, "job", "jobs");
        printf("written: %s\n", r->output_path);
    }
    if (sums->missing > 0)
        return fail_input("%u of %u jobs are not done: %s; is a shard not named, or still running?",
                          sums->missing, merge->jobs, merge->missing);
    if (failed > 0) return fail_input("%u of %u jobs have failed", failed, merge->jobs);
    return sums->found > 0 ? EXIT_CONTACT : EXIT_RAN;
}

int jobs_report_write(const jobs_report_request *r) {
    job_merge merge;
    io_error error = {""};
    interrupt_catch();
    if (!output_path_opens(r->output_path, &error) ||
        !job_merge_read(r->paths, r->count, MERGE_WHAT_IS_THERE, &merge, &error))
        return fail_input("%s", error.text);
    const int code = write_files(r, &merge, &error) ? end_report(r, &merge) : fail_input("%s", error.text);
    job_merge_free(&merge);
    return code;
}
