/* Appends results, and finds out which ones a file holds. */
#include "tool/jobs/job_results.h"

#include "tool/io/file_reader.h"
#include "tool/io/text_encoding.h"

#include <stdlib.h>
#include <string.h>

/* ---- what is there ----------------------------------------------------------------------------------------- */

enum { HELD_FOUND = 0x80 }; /* beside the outcome, from 1 */

void job_results_held(const job_results *r, uint32_t job, job_record *out) {
    *out = (job_record){.job = job,
                        .outcome = (job_outcome)((r->held[job] & ~HELD_FOUND) - 1),
                        .found = (r->held[job] & HELD_FOUND) != 0};
}

static bool job_has_failed(const job_results *r, uint32_t job) {
    return r->held[job] == JOB_FAILED + 1;
}

/* What a file must be of. */
typedef struct expected_results {
    uint64_t list;
    uint32_t jobs;
} expected_results;

/* Of several lines of one job only the last one may be without a failure. */
static bool hold_line(job_results *r, const expected_results *expected, const char *text, size_t length,
                      size_t number, io_error *error) {
    job_record record;
    if (!job_record_read(text, length, &record))
        return io_fail(error,
                       "%s:%zu: this is no line of results; give --results a file of its own, or delete the "
                       "line if it is damaged: its job runs again then",
                       r->file.path, number);
    if (record.list != expected->list || record.jobs != expected->jobs)
        return io_fail(
            error,
            "%s:%zu: these are results of another list or of other options, so nothing can be resumed; has "
            "the list been edited?",
            r->file.path, number);
    if (r->held[record.job] != 0 && !job_has_failed(r, record.job))
        return io_fail(error, "%s:%zu: job %u is there twice", r->file.path, number, record.job + 1);
    r->held[record.job] = (unsigned char)((record.outcome + 1) | (record.found ? HELD_FOUND : 0));
    return true;
}

/* The last line may have been torn by whatever ended the program. It is cut off, so it must be one of these results. */
static bool hold_torn_line(const job_results *r, const expected_results *expected, const char *text,
                           size_t length, size_t number, io_error *error) {
    return job_record_begins(text, length, expected->list, expected->jobs) ||
           io_fail(error,
                   "%s:%zu: this line has no end, and is none of these results; give --results a file of its "
                   "own",
                   r->file.path, number);
}

/* *whole: bytes of the lines that are whole. */
static bool hold_lines(job_results *r, const expected_results *expected, const file_reader *reader,
                       off_t *whole, io_error *error) {
    size_t number = 1;
    for (size_t begin = text_mark_size(reader->bytes, reader->size); begin < reader->size; number++) {
        const char *line = reader->bytes + begin, *end = memchr(line, '\n', reader->size - begin);
        if (end == NULL) return hold_torn_line(r, expected, line, reader->size - begin, number, error);
        if (!hold_line(r, expected, line, (size_t)(end - line), number, error)) return false;
        begin += (size_t)(end - line) + 1;
        *whole = (off_t)begin;
    }
    return true;
}

static bool find_held(job_results *r, resume_choice resume, const expected_results *expected,
                      io_error *error) {
    file_reader reader;
    off_t whole = 0;
    if (!file_reader_open(&reader, r->file.path, error)) return false;
    const bool good = hold_lines(r, expected, &reader, &whole, error);
    file_reader_close(&reader);
    for (uint32_t i = 0; i < expected->jobs && resume == RESUME_FAILED; i++)
        if (job_has_failed(r, i)) r->held[i] = 0;
    return good && append_file_cut(&r->file, whole, error);
}

/* ---- the file ---------------------------------------------------------------------------------------------- */

static bool begin_file(job_results *r, resume_choice resume, const expected_results *expected,
                       io_error *error) {
    if (r->held == NULL) return io_fail(error, "out of memory for %u jobs", expected->jobs);
    if (resume == RESUME_NOTHING && r->file.size > 0)
        return io_fail(
            error, "%s: holds results already; --resume goes on with them, or give --results another name",
            r->file.path);
    return r->file.size == 0 || find_held(r, resume, expected, error);
}

bool job_results_open(const char *path, resume_choice resume, uint64_t list, uint32_t jobs, job_results *out,
                      io_error *error) {
    job_results r = {.held = NULL};
    if (!append_file_open(path, &r.file, error)) return false;
    r.held = calloc(jobs, 1);
    if (!begin_file(&r, resume, &(expected_results){list, jobs}, error)) {
        job_results_drop(&r);
        return false;
    }
    *out = r;
    return true;
}

bool job_results_append(job_results *r, const char *line, size_t size, io_error *error) {
    return append_file_add(&r->file, line, size, error);
}

void job_results_drop(job_results *r) {
    append_file_drop(&r->file);
    free(r->held);
    r->held = NULL;
}

bool job_results_close(job_results *r, io_error *error) {
    const bool good = append_file_close(&r->file, error);
    job_results_drop(r);
    return good;
}
