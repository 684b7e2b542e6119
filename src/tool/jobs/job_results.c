/* Appends results, and finds out which ones a file holds. */
#include "src/tool/jobs/job_results.h"

#include "src/io/file_reader.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

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
                       r->path, number);
    if (record.list != expected->list || record.jobs != expected->jobs)
        return io_fail(
            error,
            "%s:%zu: these are results of another list or of other options, so nothing can be resumed; has "
            "the list been edited?",
            r->path, number);
    if (r->held[record.job] != 0 && !job_has_failed(r, record.job))
        return io_fail(error, "%s:%zu: job %u is there twice", r->path, number, record.job + 1);
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
                   r->path, number);
}

static bool hold_lines(job_results *r, const expected_results *expected, const file_reader *reader,
                       io_error *error) {
    size_t number = 1;
    for (size_t begin = 0; begin < reader->size; number++) {
        const char *line = reader->bytes + begin, *end = memchr(line, '\n', reader->size - begin);
        if (end == NULL) return hold_torn_line(r, expected, line, reader->size - begin, number, error);
        if (!hold_line(r, expected, line, (size_t)(end - line), number, error)) return false;
        begin += (size_t)(end - line) + 1;
        r->size = (off_t)begin;
    }
    return true;
}

static bool find_held(job_results *r, resume_choice resume, const expected_results *expected,
                      io_error *error) {
    file_reader reader;
    if (!file_reader_open(&reader, r->path, error)) return false;
    const bool good = hold_lines(r, expected, &reader, error);
    file_reader_close(&reader);
    for (uint32_t i = 0; i < expected->jobs && resume == RESUME_FAILED; i++)
        if (job_has_failed(r, i)) r->held[i] = 0;
    return good;
}

/* ---- the file ---------------------------------------------------------------------------------------------- */

/* File systems without locks are taken as they are. */
static bool lock_file(const job_results *r, io_error *error) {
    if (flock(r->file, LOCK_EX | LOCK_NB) == 0 || errno == ENOLCK || errno == EOPNOTSUPP || errno == ENOSYS)
        return true;
    if (errno == EWOULDBLOCK)
        return io_fail(
            error, "%s: another process writes its results here; give each shard a file of its own", r->path);
    return io_fail(error, "%s: cannot lock: %s", r->path, strerror(errno));
}

/* Devices, as /dev/null is one, take lines and hold none. */
static bool measure_file(job_results *r, off_t *size, io_error *error) {
    struct stat status;
    if (fstat(r->file, &status) != 0) return io_fail(error, "%s: cannot write: %s", r->path, strerror(errno));
    if (S_ISFIFO(status.st_mode))
        return io_fail(error, "%s: is a pipe, and results are kept in a file; name one", r->path);
    r->regular = S_ISREG(status.st_mode);
    *size = r->regular ? status.st_size : 0;
    return true;
}

static bool begin_file(job_results *r, resume_choice resume, const expected_results *expected,
                       io_error *error) {
    if (r->held == NULL) return io_fail(error, "out of memory for %u jobs", expected->jobs);
    off_t size = 0;
    if (!lock_file(r, error) || !measure_file(r, &size, error)) return false;
    if (resume == RESUME_NOTHING && size > 0)
        return io_fail(
            error, "%s: holds results already; --resume goes on with them, or give --results another name",
            r->path);
    if (size == 0) return true;
    if (!find_held(r, resume, expected, error)) return false;
    return size == r->size || ftruncate(r->file, r->size) == 0 ||
           io_fail(error, "%s: cannot write: %s", r->path, strerror(errno));
}

bool job_results_open(const char *path, resume_choice resume, uint64_t list, uint32_t jobs, job_results *out,
                      io_error *error) {
    job_results r = {.path = path, .file = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)};
    if (r.file < 0) return io_fail(error, "%s: cannot write: %s", path, strerror(errno));
    r.held = calloc(jobs, 1);
    if (!begin_file(&r, resume, &(expected_results){list, jobs}, error)) {
        job_results_drop(&r);
        return false;
    }
    *out = r;
    return true;
}

/* What would be written to a file that has no name any more, or that somebody else changes, would be lost. */
static bool file_is_ours(const job_results *r, io_error *error) {
    struct stat own, named;
    if (!r->regular || fstat(r->file, &own) != 0) return true;
    const bool is_there = stat(r->path, &named) == 0;
    if ((!is_there && errno == ENOENT) ||
        (is_there && (named.st_dev != own.st_dev || named.st_ino != own.st_ino)))
        return io_fail(
            error, "%s: was removed or replaced while the jobs ran, and its results with it; run them again",
            r->path);
    return own.st_size == r->size ||
           io_fail(error, "%s: was changed by another process while the jobs ran; --resume goes on with it",
                   r->path);
}

bool job_results_append(job_results *r, const char *line, size_t size, io_error *error) {
    size_t written = 0;
    if (!file_is_ours(r, error)) return false;
    while (written < size) {
        const ssize_t more = write(r->file, line + written, size - written);
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) {
            const int cause = errno;
            if (written > 0 && ftruncate(r->file, r->size) != 0) written = 0; /* resuming cuts it off */
            return io_fail(error, "%s: cannot write: %s", r->path, strerror(cause));
        }
        written += (size_t)more;
    }
    r->size += (off_t)size;
    return true;
}

void job_results_drop(job_results *r) {
    if (r->file >= 0) close(r->file);
    free(r->held);
    *r = (job_results){.file = -1};
}

bool job_results_close(job_results *r, io_error *error) {
    const char *path = r->path;
    const bool open = r->file >= 0;
    if (open && !file_is_ours(r, error)) {
        job_results_drop(r);
        return false;
    }
    const bool good = !open || (fsync(r->file) == 0 || errno == EINVAL || errno == EROFS);
    const int cause = errno;
    job_results_drop(r);
    return good || io_fail(error, "%s: cannot write: %s", path, strerror(cause));
}
