/* Lines of results: the members that every line has, the sums of many lines, the results that a file holds,
 * and how a worker packs one. */
#include "tool/jobs/job_list.h"

#include "tool/io/file_reader.h"
#include "tool/io/json.h"
#include "tool/io/text_encoding.h"

#include <inttypes.h>
#include <json-c/json.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* ---- lines --------------------------------------------------------------------------------------------- */

static const char *const outcome_names[JOB_OUTCOMES] = {"clean",     "crossing", "touching",
                                                        "duplicate", "inside",   "failed"};

const char *job_outcome_name(job_outcome outcome) {
    return outcome_names[outcome];
}

/* Begins a line with these members. */
static void job_record_write(json *line, const job_record *r) {
    char digits[17];
    snprintf(digits, sizeof digits, "%016" PRIx64, r->list);
    json_begin_object(line, NULL);
    json_string(line, "list", digits);
    json_integer(line, "jobs", r->jobs);
    json_integer(line, "job", (uint64_t)r->job + 1);
    json_string(line, "result", job_outcome_name(r->outcome));
    json_boolean(line, "found", r->found);
}

/* Is this how a line of the list begins? The text may end anywhere, or with characters 0, as files do after a
 * power cut. */
static bool job_record_begins(const char *text, size_t length, uint64_t list, uint32_t jobs) {
    char begin[80];
    snprintf(begin, sizeof begin, "{\"list\":\"%016" PRIx64 "\",\"jobs\":%" PRIu32 ",\"job\":", list, jobs);
    while (length > 0 && text[length - 1] == '\0') length--;
    const size_t known = strlen(begin);
    return memcmp(text, begin, length < known ? length : known) == 0;
}

/* ---- reading --------------------------------------------------------------------------------------------- */

static bool read_count(json_object *root, const char *name, uint32_t *out) {
    json_object *value = json_object_object_get(root, name);
    const int64_t count = json_object_is_type(value, json_type_int) ? json_object_get_int64(value) : 0;
    *out = (uint32_t)count;
    return count > 0 && count <= JOB_COUNT_MAX;
}

static bool read_hash(json_object *root, uint64_t *out) {
    json_object *value = json_object_object_get(root, "list");
    const char *text = json_object_is_type(value, json_type_string) ? json_object_get_string(value) : "";
    if (strlen(text) != 16 || strspn(text, "0123456789abcdef") != 16) return false;
    *out = strtoull(text, NULL, 16);
    return true;
}

static bool read_outcome(json_object *root, job_outcome *out) {
    json_object *value = json_object_object_get(root, "result");
    const char *text = json_object_is_type(value, json_type_string) ? json_object_get_string(value) : "";
    int i = 0;
    while (i < JOB_OUTCOMES && strcmp(text, outcome_names[i]) != 0) i++;
    *out = (job_outcome)i;
    return i < JOB_OUTCOMES;
}

static bool read_members(json_object *root, job_record *out) {
    json_object *found =
        json_object_is_type(root, json_type_object) ? json_object_object_get(root, "found") : NULL;
    if (!json_object_is_type(found, json_type_boolean) || !read_hash(root, &out->list) ||
        !read_count(root, "jobs", &out->jobs) || !read_count(root, "job", &out->job) || out->job > out->jobs)
        return false;
    out->job--;
    out->found = json_object_get_boolean(found);
    return read_outcome(root, &out->outcome);
}

bool job_record_read(const char *text, size_t length, job_record *out) {
    json_tokener *parser = length < INT_MAX && json_has_room(text, length) ? json_tokener_new() : NULL;
    if (parser == NULL) return false;
    json_object *root = json_tokener_parse_ex(parser, text, (int)length);
    const bool whole = root != NULL && json_tokener_get_parse_end(parser) == length;
    job_record record;
    const bool good = whole && read_members(root, &record);
    json_object_put(root);
    json_tokener_free(parser);
    if (good) *out = record;
    return good;
}

/* ---- sums ------------------------------------------------------------------------------------------------ */

void job_sums_add(job_sums *sums, const job_record *record) {
    sums->outcomes[record->outcome]++;
    sums->found += record->found;
}

void job_sums_print(FILE *out, const job_sums *sums, const char *one, const char *several) {
    const uint32_t *of = sums->outcomes;
    uint32_t count = sums->missing;
    for (int i = 0; i < JOB_OUTCOMES; i++) count += of[i];
    if (sums->missing > 0) fputs("Not finished: ", out);
    fprintf(out, "%u %s: %u clean", count, count == 1 ? one : several, of[JOB_CLEAN]);
    if (of[JOB_CROSSING] > 0) fprintf(out, ", %u with intersections", of[JOB_CROSSING]);
    if (of[JOB_INSIDE] > 0) fprintf(out, ", %u with parts that share space", of[JOB_INSIDE]);
    if (of[JOB_TOUCHING] > 0) fprintf(out, ", %u only touching", of[JOB_TOUCHING]);
    if (of[JOB_DUPLICATE] > 0) fprintf(out, ", %u only with duplicates", of[JOB_DUPLICATE]);
    if (of[JOB_FAILED] > 0) fprintf(out, ", %u failed", of[JOB_FAILED]);
    if (sums->missing > 0) fprintf(out, ", %u not done", sums->missing);
    fputc('\n', out);
}

/* ---- the results that a file holds --------------------------------------------------------------------- */

enum { HELD_FOUND = 0x80 }; /* beside the outcome, from 1 */

void job_results_held(const job_results *r, uint32_t job, job_record *out) {
    *out = (job_record){.job = job,
                        .outcome = (job_outcome)((r->held[job] & ~HELD_FOUND) - 1),
                        .found = (r->held[job] & HELD_FOUND) != 0};
}

static bool job_has_failed(const job_results *r, uint32_t job) {
    return r->held[job] == JOB_FAILED + 1;
}

/* The list whose results a file must hold. */
typedef struct expected_results {
    uint64_t list;
    uint32_t jobs;
} expected_results;

/* Only the last of several lines of one job may be without a failure. */
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

/* The last line may have been torn by whatever ended the program. It is cut off, so it must be one of these
 * results. */
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

/* ---- packed results ------------------------------------------------------------------------------------ */

/* Packed results begin with this; the text comes behind it, and then the line. */
typedef struct sent_result {
    job_record record;
    uint64_t text_size; /* with its 0 */
} sent_result;

/* A text that is written to as a file. */
typedef struct memory_text {
    FILE *file;
    char *text;
    size_t size;
} memory_text;

static bool open_text(memory_text *t) {
    *t = (memory_text){.file = NULL};
    t->file = open_memstream(&t->text, &t->size);
    return t->file != NULL;
}

static bool close_text(memory_text *t) {
    const bool good = t->file != NULL && fclose(t->file) == 0 && t->text != NULL;
    t->file = NULL;
    return good;
}

typedef struct job_texts {
    memory_text text, members;
    json out;
    job_output output;
} job_texts;

static bool open_texts(job_texts *t) {
    *t = (job_texts){.out = {.depth = 1, .has_items = {true, true}}};
    const bool good = open_text(&t->text) && open_text(&t->members);
    t->out.file = t->members.file;
    t->output = (job_output){.text = t->text.file, .members = &t->out};
    return good;
}

static void free_texts(job_texts *t) {
    close_text(&t->text);
    close_text(&t->members);
    free(t->text.text);
    free(t->members.text);
}

/* Writes what is sent of a job. False: memory is short. */
static bool write_result(const job_work *work, uint32_t job, job_texts *t, FILE *out) {
    if (!close_text(&t->text) || !close_text(&t->members)) return false;
    if (t->text.size > 0 && t->text.text[t->text.size - 1] == '\n') t->text.text[--t->text.size] = '\0';
    const sent_result sent = {.record = {.list = work->hash,
                                         .jobs = work->list->count,
                                         .job = job,
                                         .outcome = t->output.outcome,
                                         .found = t->output.found},
                              .text_size = t->text.size + 1};
    json line = {.file = out};
    fwrite(&sent, sizeof sent, 1, out);
    fwrite(t->text.text, 1, sent.text_size, out);
    job_record_write(&line, &sent.record);
    fwrite(t->members.text, 1, t->members.size, out);
    json_end_object(&line);
    fputc('\n', out);
    return ferror(out) == 0;
}

void job_work_fail(const job_work *work, uint32_t job, const char *reason, FILE *out) {
    job_line line;
    job_texts texts;
    io_error error;
    const bool named = job_list_line(work->list, job, &line, &error);
    if (open_texts(&texts)) {
        texts.output.outcome = JOB_FAILED;
        work->kind->fail(work->kind->user, named ? line.name : "", reason, &texts.output);
        write_result(work, job, &texts, out);
    }
    free_texts(&texts);
    if (named) job_line_free(&line);
}

bool job_work_run(const job_work *work, uint32_t job, FILE *out) {
    job_line line;
    job_texts texts;
    io_error error = {"out of memory"};
    if (!job_list_line(work->list, job, &line, &error)) {
        job_work_fail(work, job, error.text, out);
        return true;
    }
    const bool ran =
        open_texts(&texts) && work->kind->run(work->kind->user, &line, work->context, &texts.output, &error);
    const bool given_up = texts.output.given_up;
    if (ran) write_result(work, job, &texts, out);
    free_texts(&texts);
    job_line_free(&line);
    if (!ran && !given_up) job_work_fail(work, job, error.text, out);
    return !given_up;
}

job_result job_work_unpack(const char *bytes, size_t size) {
    sent_result sent;
    memcpy(&sent, bytes, sizeof sent);
    const char *text = bytes + sizeof sent, *line = text + sent.text_size;
    return (job_result){
        .record = sent.record, .text = text, .line = line, .line_size = size - (size_t)(line - bytes)};
}
