/* Lists of jobs: which lines they have, and the hash that tells them apart. */
#include "tool/jobs/job_list.h"

#include "tool/common/provenance.h"
#include "tool/io/file_reader.h"
#include "tool/io/growable.h"
#include "tool/io/text_encoding.h"

#include <stdlib.h>
#include <string.h>

static bool line_is_blank(const char *text, size_t length) {
    size_t i = 0;
    while (i < length && strchr(" \t\r", text[i]) != NULL) i++;
    return i == length;
}

bool job_list_fail(const job_list *list, uint32_t job, const char *reason, io_error *error) {
    if (list->path == NULL) return io_fail(error, "%s: %s", list->jobs[job].text, reason);
    return io_fail(error, "%s:%zu: %s", list->path, list->jobs[job].line, reason);
}

bool job_list_line(const job_list *list, uint32_t job, job_line *out, io_error *error) {
    const listed_job *j = &list->jobs[job];
    if (list->path != NULL) return job_line_read(j->text, j->length, out, error);
    const char **inputs = malloc(sizeof *inputs);
    if (inputs == NULL) return io_fail(error, "out of memory");
    inputs[0] = j->text;
    *out = (job_line){.name = j->text, .inputs = inputs, .input_count = 1, .size = NO_JOB_SIZE};
    return true;
}

/* Finds the lines that hold a job. */
static bool split_lines(job_list *list, size_t size, io_error *error) {
    growable jobs = growable_of(sizeof(listed_job));
    size_t line = 1;
    for (size_t begin = text_mark_size(list->text, size), end; begin < size; begin = end + 1, line++) {
        const char *newline = memchr(list->text + begin, '\n', size - begin);
        end = newline != NULL ? (size_t)(newline - list->text) : size;
        if (line_is_blank(list->text + begin, end - begin)) continue;
        listed_job *job = jobs.count < JOB_COUNT_MAX ? growable_push(&jobs) : NULL;
        if (job == NULL) {
            const bool full = jobs.count == JOB_COUNT_MAX;
            growable_free(&jobs);
            return full ? io_fail(error, "%s: a list has %d jobs at most; cut it in several", list->path,
                                  JOB_COUNT_MAX)
                        : io_fail(error, "%s: out of memory", list->path);
        }
        *job = (listed_job){.text = list->text + begin, .length = end - begin, .line = line};
    }
    list->count = (uint32_t)jobs.count;
    list->jobs = growable_take(&jobs);
    return list->count > 0 || io_fail(error, "%s: there is no job in the list", list->path);
}

static bool read_lines(job_list *list, io_error *error) {
    io_error reason;
    for (uint32_t i = 0; i < list->count; i++) {
        job_line line;
        if (!job_line_read(list->jobs[i].text, list->jobs[i].length, &line, &reason))
            return job_list_fail(list, i, reason.text, error);
        list->jobs[i].size = line.size;
        job_line_free(&line);
    }
    return true;
}

bool job_list_read(const char *path, job_list *out, io_error *error) {
    file_reader reader;
    job_list list = {.path = path};
    if (!file_reader_open(&reader, path, error)) return false;
    list.text = reader.bytes;
    reader.bytes = NULL;
    list.hash = provenance_hash(PROVENANCE_HASH_START, list.text, reader.size);
    const bool good =
        (!text_is_utf16(list.text, reader.size) || file_reader_fail(&reader, TEXT_UTF16_ADVICE)) &&
        split_lines(&list, reader.size, error) && read_lines(&list, error);
    file_reader_close(&reader);
    if (!good) job_list_free(&list);
    if (good) *out = list;
    return good;
}

bool job_list_of_names(const char *const *names, size_t count, job_list *out, io_error *error) {
    job_list list = {.hash = PROVENANCE_HASH_START, .count = (uint32_t)count};
    if (count > JOB_COUNT_MAX)
        return io_fail(error, "a list has %d jobs at most; cut it in several", JOB_COUNT_MAX);
    list.jobs = malloc((count + 1) * sizeof *list.jobs);
    if (list.jobs == NULL) return io_fail(error, "out of memory for %zu jobs", count);
    for (size_t i = 0; i < count; i++) {
        const size_t length = strlen(names[i]);
        list.jobs[i] = (listed_job){.text = names[i], .length = length, .size = NO_JOB_SIZE, .line = i + 1};
        list.hash = provenance_hash(list.hash, names[i], length + 1);
    }
    *out = list;
    return true;
}

void job_list_free(job_list *list) {
    free(list->text);
    free(list->jobs);
    *list = (job_list){.path = NULL};
}
