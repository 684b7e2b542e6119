/* Brings the results of all shards together: finds the line of each job, copies them in order, writes them as
 * JUnit, and reads what a page says of a job. */
#include "tool/jobs/jobs.h"

#include "tool/common/terminal.h"
#include "tool/io/file_reader.h"
#include "tool/io/text_encoding.h"

#include <errno.h>
#include <json-c/json.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

/* ---- merging ------------------------------------------------------------------------------------------- */

/* ---- lines --------------------------------------------------------------------------------------------------------- */

/* NULL: there is none. */
static const merged_line *line_of(const job_merge *m, uint32_t job) {
    const merged_line *page = m->pages[job / MERGE_PAGE];
    return page != NULL && page[job % MERGE_PAGE].length > 0 ? &page[job % MERGE_PAGE] : NULL;
}

/* The place for the line of a job, zeroed at first; NULL: memory is short. */
static merged_line *place_of(job_merge *m, uint32_t job) {
    merged_line **page = &m->pages[job / MERGE_PAGE];
    if (*page == NULL) *page = calloc(MERGE_PAGE, sizeof **page);
    return *page != NULL ? &(*page)[job % MERGE_PAGE] : NULL;
}

static uint32_t page_count(const job_merge *m) {
    return m->jobs / MERGE_PAGE + 1;
}

/* ---- one file ------------------------------------------------------------------------------------------------------ */

static bool begin_merge(job_merge *m, const job_record *first, uint32_t file, io_error *error) {
    m->first = file;
    m->list = first->list;
    m->jobs = first->jobs;
    m->pages = calloc(page_count(m), sizeof *m->pages);
    return m->pages != NULL || io_fail(error, "out of memory for %u jobs", m->jobs);
}

/* A job that failed may have been run again, by the same shard. */
static bool replaces_failure(const merged_line *before, uint32_t file) {
    return before->file == file && before->record.outcome == JOB_FAILED;
}

static bool place_line(job_merge *m, const merged_line *line, size_t number, io_error *error) {
    const job_record *record = &line->record;
    const char *path = m->paths[line->file];
    if (m->pages == NULL && !begin_merge(m, record, line->file, error)) return false;
    if (record->list != m->list || record->jobs != m->jobs)
        return io_fail(error,
                       "%s:%zu: these are results of another list or of other options than those of %s", path,
                       number, m->paths[m->first]);
    merged_line *place = place_of(m, record->job);
    if (place == NULL) return io_fail(error, "out of memory for %u jobs", m->jobs);
    if (place->length > 0 && place->file != line->file && strcmp(m->paths[place->file], path) == 0)
        return io_fail(error, "%s is named twice", path);
    if (place->length > 0 && !replaces_failure(place, line->file))
        return io_fail(error, "%s:%zu: job %u is in %s as well", path, number, record->job + 1,
                       m->paths[place->file]);
    *place = *line;
    return true;
}

static bool read_line(job_merge *m, const file_reader *reader, merged_line *line, size_t number,
                      io_error *error) {
    const char *text = reader->bytes + line->offset, *end = memchr(text, '\n', reader->size - line->offset);
    if (end == NULL && m->rule == MERGE_WHAT_IS_THERE && reader->size - line->offset < UINT32_MAX) {
        line->length = (uint32_t)(reader->size - line->offset);
        return true;
    }
    if (end == NULL)
        return io_fail(error, "%s:%zu: the line is torn; go on with this shard by --resume", reader->path,
                       number);
    if (end - text >= UINT32_MAX || !job_record_read(text, (size_t)(end - text), &line->record))
        return io_fail(error, "%s:%zu: this is no line of results", reader->path, number);
    line->length = (uint32_t)(end - text) + 1;
    return place_line(m, line, number, error);
}

static bool read_file(job_merge *m, uint32_t file, io_error *error) {
    file_reader reader;
    if (!file_reader_open(&reader, m->paths[file], error)) return false;
    bool good = true;
    size_t number = 1;
    for (uint64_t at = text_mark_size(reader.bytes, reader.size); at < reader.size && good; number++) {
        merged_line line = {.offset = at, .file = file};
        good = read_line(m, &reader, &line, number, error);
        at += line.length;
    }
    file_reader_close(&reader);
    return good;
}

/* ---- all of them --------------------------------------------------------------------------------------------------- */

enum { RANGES_NAMED = 5 };

static void name_missing(job_merge *m) {
    uint32_t ranges = 0;
    char *text = m->missing;
    size_t used = 0, size = sizeof m->missing;
    for (uint32_t i = 0, end; i < m->jobs; i = end) {
        end = i + 1;
        if (line_of(m, i) != NULL) continue;
        while (end < m->jobs && line_of(m, end) == NULL) end++;
        m->sums.missing += end - i;
        if (++ranges > RANGES_NAMED) continue;
        used += (size_t)snprintf(text + used, size - used, "%s%u", ranges > 1 ? ", " : "", i + 1);
        if (end - i > 1) used += (size_t)snprintf(text + used, size - used, " to %u", end);
    }
    if (ranges > RANGES_NAMED) snprintf(text + used, size - used, " and others");
}

static bool prove_whole(job_merge *m, io_error *error) {
    if (m->pages == NULL) return io_fail(error, "%s: there are no results", m->paths[0]);
    name_missing(m);
    return m->sums.missing == 0 || m->rule == MERGE_WHAT_IS_THERE ||
           io_fail(
               error,
               "%u of %u jobs are missing: %s; is a shard not named, or not done? (--resume goes on with one)",
               m->sums.missing, m->jobs, m->missing);
}

bool job_merge_read(const char *const *paths, size_t count, job_merge_rule rule, job_merge *out,
                    io_error *error) {
    job_merge m = {.paths = paths, .path_count = count, .rule = rule};
    bool good = true;
    for (uint32_t i = 0; i < count && good; i++) good = read_file(&m, i, error);
    good = good && prove_whole(&m, error);
    for (uint32_t i = 0; i < m.jobs && good; i++)
        if (line_of(&m, i) != NULL) job_sums_add(&m.sums, &line_of(&m, i)->record);
    if (!good) job_merge_free(&m);
    if (good) *out = m;
    return good;
}

/* ---- the lines ------------------------------------------------------------------------------------------------------- */

typedef struct line_copier {
    FILE **files; /* opened when the first of their lines comes */
    size_t file_count;
    char *text;
    size_t capacity;
} line_copier;

static void close_files(line_copier *c) {
    for (size_t i = 0; i < c->file_count; i++) {
        if (c->files[i] != NULL) fclose(c->files[i]);
        c->files[i] = NULL;
    }
}

/* A pipe would have to be written again. Where the system has no room for all files, others are closed, and
 * opened again later. */
static bool open_again(const char *path, line_copier *c, uint32_t index, io_error *error) {
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode))
        return io_fail(error, "%s: is read twice, so it must be a file, and no pipe", path);
    FILE *file = fopen(path, "rb");
    if (file == NULL && (errno == EMFILE || errno == ENFILE)) {
        close_files(c);
        file = fopen(path, "rb");
    }
    c->files[index] = file;
    return file != NULL || io_fail(error, "%s: cannot open: %s", path, strerror(errno));
}

static bool same_record(const job_record *a, const job_record *b) {
    return a->list == b->list && a->jobs == b->jobs && a->job == b->job && a->outcome == b->outcome &&
           a->found == b->found;
}

static bool read_again(const job_merge *m, line_copier *c, const merged_line *line, io_error *error) {
    const char *path = m->paths[line->file];
    if (line->length > c->capacity) {
        char *room = realloc(c->text, line->length);
        if (room == NULL) return io_fail(error, "out of memory");
        c->text = room;
        c->capacity = line->length;
    }
    if (c->files[line->file] == NULL && !open_again(path, c, line->file, error)) return false;
    FILE *file = c->files[line->file];
    if (ftello(file) != (off_t)line->offset && fseeko(file, (off_t)line->offset, SEEK_SET) != 0)
        return io_fail(error, "%s: cannot read: %s", path, strerror(errno));
    job_record record;
    return (fread(c->text, 1, line->length, file) == line->length &&
            job_record_read(c->text, line->length - 1, &record) && same_record(&record, &line->record)) ||
           io_fail(error, "%s: has changed while it was read; is its shard still running?", path);
}

/* A file of a shard each, all of them open at once. */
static void allow_files(size_t count) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur > count + 16) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

static bool take_missing(const job_merge *m, uint32_t job, job_line_taker *take, void *user,
                         io_error *error) {
    const job_record record = {.list = m->list, .jobs = m->jobs, .job = job};
    return take(user, NULL, 0, &record, error);
}

bool job_merge_visit(const job_merge *m, job_line_taker *take, void *user, io_error *error) {
    allow_files(m->path_count);
    line_copier c = {.files = calloc(m->path_count, sizeof *c.files), .file_count = m->path_count};
    bool good = c.files != NULL || io_fail(error, "out of memory");
    for (uint32_t i = 0; i < m->jobs && good && !interrupted(); i++) {
        const merged_line *line = line_of(m, i);
        good = line == NULL ? take_missing(m, i, take, user, error)
                            : read_again(m, &c, line, error) &&
                                  take(user, c.text, line->length - 1, &line->record, error);
    }
    if (c.files != NULL) close_files(&c);
    free(c.files);
    free(c.text);
    return good;
}

void job_merge_free(job_merge *m) {
    for (uint32_t i = 0; m->pages != NULL && i < page_count(m); i++) free(m->pages[i]);
    free(m->pages);
    *m = (job_merge){.paths = NULL};
}

/* ---- writes results of jobs as JUnit's XML --------------------------------------------------------------- */

void job_junit_begin(FILE *out, const char *suite, const job_sums *sums) {
    uint32_t count = sums->missing;
    for (int i = 0; i < JOB_OUTCOMES; i++) count += sums->outcomes[i];
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"", out);
    text_write_xml(out, suite);
    fprintf(out, "\" tests=\"%u\" failures=\"%u\" errors=\"%u\">\n", count, sums->found,
            sums->outcomes[JOB_FAILED] + sums->missing);
}

void job_junit_end(FILE *out) {
    fputs("  </testsuite>\n</testsuites>\n", out);
}

/* The text of a member; NULL: it is not there, or null. */
static const char *find_text(json_object *line, const char *name) {
    json_object *value = json_object_object_get(line, name);
    return json_object_is_type(value, json_type_string) ? json_object_get_string(value) : NULL;
}

static void write_message(FILE *out, const char *element, const char *message) {
    fprintf(out, ">\n      <%s message=\"", element);
    text_write_xml(out, message != NULL ? message : "");
    fputs("\"/>\n    </testcase>\n", out);
}

/* Its name stands in the list alone. */
static void add_missing(FILE *out, const job_record *record) {
    fprintf(out, "    <testcase classname=\"cscd\" name=\"job %u\"", record->job + 1);
    write_message(out, "error", "not done");
}

/* Lines of meshes have a file in place of a name, and no sentence. */
bool job_junit_add(FILE *out, const char *line, size_t length, const job_record *record) {
    if (line == NULL) {
        add_missing(out, record);
        return true;
    }
    json_tokener *parser = json_tokener_new();
    if (parser == NULL) return false;
    json_object *root = json_tokener_parse_ex(parser, line, (int)length);
    const char *name = find_text(root, "name"), *file = find_text(root, "file"),
               *answer = find_text(root, "answer");
    fprintf(out, "    <testcase classname=\"cscd\" name=\"");
    text_write_xml(out, name != NULL ? name : file != NULL ? file : "");
    fputc('"', out);
    if (record->outcome == JOB_FAILED)
        write_message(out, "error", find_text(root, "error"));
    else if (record->found)
        write_message(out, "failure", answer != NULL ? answer : job_outcome_name(record->outcome));
    else
        fputs("/>\n", out);
    json_object_put(root);
    json_tokener_free(parser);
    return true;
}

/* ---- rows of a page ------------------------------------------------------------------------------------ */

/* The text of the first of two members that is one. */
static const char *find_first_text(json_object *line, const char *name, const char *other) {
    json_object *value = json_object_object_get(line, name);
    if (!json_object_is_type(value, json_type_string)) value = json_object_object_get(line, other);
    const char *text = json_object_is_type(value, json_type_string) ? json_object_get_string(value) : NULL;
    return text != NULL ? text : "";
}

static double find_first_number(json_object *line, const char *name, const char *other) {
    json_object *value = json_object_object_get(line, name);
    if (value == NULL) value = json_object_object_get(line, other);
    const bool is_number =
        json_object_is_type(value, json_type_int) || json_object_is_type(value, json_type_double);
    return is_number ? json_object_get_double(value) : NAN;
}

bool job_row_read(const char *text, size_t length, job_row *out) {
    json_tokener *parser = length < INT_MAX ? json_tokener_new() : NULL;
    if (parser == NULL) return false;
    json_object *line = json_tokener_parse_ex(parser, text, (int)length);
    json_tokener_free(parser);
    if (!json_object_is_type(line, json_type_object)) {
        json_object_put(line);
        return false;
    }
    *out = (job_row){
        .name = find_first_text(line, "name", "file"),
        .answer = find_first_text(line, "error", "answer"),
        .report = find_first_text(line, "report", "report"),
        .frames = find_first_number(line, "frames_checked", "frames"),
        .crossing_frames = find_first_number(line, "frames_crossing", "frames_crossing"),
        .events = find_first_number(line, "events", "events"),
        .depth = find_first_number(line, "depth", "depth"),
        .crossing_pairs = find_first_number(line, "crossing_pairs", "crossing"),
        .seconds = 1e-3 * (find_first_number(line, "read_ms", "read_ms") +
                           find_first_number(line, "check_ms", "check_ms")),
        .memory = line,
    };
    return true;
}

void job_row_free(job_row *row) {
    json_object_put(row->memory);
    *row = (job_row){.memory = NULL};
}
