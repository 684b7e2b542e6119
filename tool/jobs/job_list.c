/* Reads lists of jobs, a file of JSON Lines or names of meshes, and says which jobs of a list are whose. */
#include "tool/jobs/job_list.h"

#include "tool/common/command.h"
#include "tool/common/provenance.h"
#include "tool/io/file_reader.h"
#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/io/text_encoding.h"

#include <json-c/json.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* ---- lists --------------------------------------------------------------------------------------------- */

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

/* ---- lines of a list of jobs, which are JSON objects ----------------------------------------------------- */

enum { DEPTH_MAX = 8 };

typedef struct line_reader {
    json_object *root;
    growable inputs, options; /* const char *, job_option */
    io_error *error;
} line_reader;

/* ---- values ---------------------------------------------------------------------------------------------- */

/* The text of a string, or of a number as the line has it; NULL with the error. */
static const char *read_value(line_reader *r, json_object *value, const char *name) {
    const bool is_text = json_object_is_type(value, json_type_string);
    if (!is_text && !json_object_is_type(value, json_type_int) &&
        !json_object_is_type(value, json_type_double)) {
        io_fail(r->error, "'%s' must be a text or a number", name);
        return NULL;
    }
    const char *text = json_object_get_string(value);
    if (text == NULL)
        io_fail(r->error, "out of memory");
    else if (is_text && strlen(text) != (size_t)json_object_get_string_len(value)) {
        io_fail(r->error, "'%s' has a character 0", name);
        return NULL;
    }
    return text;
}

static bool add_input(line_reader *r, json_object *value, const char *name) {
    const char **place;
    if (!json_object_is_type(value, json_type_string))
        return io_fail(r->error, "'%s' must be the name of a file", name);
    const char *text = read_value(r, value, name);
    if (text == NULL) return false;
    if (text[0] == '\0') return io_fail(r->error, "'%s' is empty", name);
    place = growable_push(&r->inputs);
    if (place == NULL) return io_fail(r->error, "out of memory");
    *place = text;
    return true;
}

/* An array has several values, as an option that is given as often as needed. */
static bool add_inputs(line_reader *r, json_object *value, const char *name) {
    if (value == NULL) return true;
    if (!json_object_is_type(value, json_type_array)) return add_input(r, value, name);
    for (size_t i = 0; i < json_object_array_length(value); i++)
        if (!add_input(r, json_object_array_get_idx(value, i), name)) return false;
    return true;
}

static bool add_option(line_reader *r, const char *name, json_object *value) {
    const char *text = NULL;
    if (!json_object_is_type(value, json_type_boolean)) {
        text = read_value(r, value, name);
        if (text == NULL) return false;
    } else if (!json_object_get_boolean(value))
        return true;
    job_option *option = growable_push(&r->options);
    if (option == NULL) return io_fail(r->error, "out of memory");
    *option = (job_option){name, text};
    return true;
}

/* A value that is null or false is not given. */
static bool add_options(line_reader *r, const char *name, json_object *value) {
    if (value == NULL) return true;
    if (!json_object_is_type(value, json_type_array)) return add_option(r, name, value);
    for (size_t i = 0; i < json_object_array_length(value); i++)
        if (!add_option(r, name, json_object_array_get_idx(value, i))) return false;
    return true;
}

static bool add_object(line_reader *r, json_object *object, const char *name) {
    if (object == NULL) return true;
    if (!json_object_is_type(object, json_type_object))
        return io_fail(r->error, "'%s' must be an object, as {\"json\": \"a.json\"}", name);
    json_object_object_foreach(object, key, value) {
        if (!add_options(r, key, value)) return false;
    }
    return true;
}

/* ---- members --------------------------------------------------------------------------------------------- */

static bool know_members(const line_reader *r) {
    static const char *const known[] = {"name", "model", "frames", "size", "parts", "options", "outputs"};
    json_object_object_foreach(r->root, key, value) {
        (void)value;
        bool found = false;
        for (size_t i = 0; i < sizeof known / sizeof *known; i++) found |= strcmp(key, known[i]) == 0;
        if (!found)
            return io_fail(
                r->error,
                "'%s' is no member of a job; name, model, frames, size, parts, options and outputs are", key);
    }
    return true;
}

static bool read_size(const line_reader *r, uint64_t *out) {
    json_object *value = json_object_object_get(r->root, "size");
    *out = NO_JOB_SIZE;
    if (value == NULL) return true;
    const int64_t size = json_object_is_type(value, json_type_int) ? json_object_get_int64(value) : -1;
    if (size < 0 || (uint64_t)size > JOB_SIZE_MAX)
        return io_fail(r->error, "'size' must be a whole number from 0 to 10^12");
    *out = (uint64_t)size;
    return true;
}

static bool read_name(line_reader *r, const char **out) {
    json_object *value = json_object_object_get(r->root, "name");
    const char *const *inputs = r->inputs.data;
    *out = inputs != NULL ? inputs[0] : NULL;
    if (value != NULL) {
        *out = read_value(r, value, "name");
        return *out != NULL;
    }
    return *out != NULL ||
           io_fail(r->error, "a job needs a 'model', or a 'name' where options have its objects");
}

static bool read_members(line_reader *r, job_line *out) {
    json_object *root = r->root;
    json_object *model = json_object_object_get(root, "model"),
                *frames = json_object_object_get(root, "frames");
    if (!know_members(r) || !read_size(r, &out->size)) return false;
    if (model != NULL && !add_input(r, model, "model")) return false;
    if (model == NULL && frames != NULL) return io_fail(r->error, "'frames' need a 'model'");
    return add_inputs(r, frames, "frames") && read_name(r, &out->name) &&
           add_options(r, "parts", json_object_object_get(root, "parts")) &&
           add_object(r, json_object_object_get(root, "options"), "options") &&
           add_object(r, json_object_object_get(root, "outputs"), "outputs");
}

/* ---- lines ----------------------------------------------------------------------------------------------- */

static json_object *parse_line(const char *text, size_t length, io_error *error) {
    if (!json_has_room(text, length)) {
        io_fail(error, "more objects than one in ten bytes, expected a job");
        return NULL;
    }
    json_tokener *parser = length < INT_MAX ? json_tokener_new_ex(DEPTH_MAX) : NULL;
    if (parser == NULL) {
        io_fail(error, "out of memory");
        return NULL;
    }
    json_tokener_set_flags(parser, JSON_TOKENER_STRICT);
    /* The 0 behind the line ends a line that has too little. */
    json_object *root = json_tokener_parse_ex(parser, text, (int)length + 1);
    const enum json_tokener_error cause = json_tokener_get_error(parser);
    const size_t end = json_tokener_get_parse_end(parser);
    if (root == NULL && cause != json_tokener_success)
        io_fail(error, "no valid JSON at character %zu: %s", end + 1,
                cause == json_tokener_error_parse_eof ? "the line ends too early"
                                                      : json_tokener_error_desc(cause));
    else if (!json_object_is_type(root, json_type_object)) {
        io_fail(error, "a job must be an object, as {\"model\": \"body.obj\"}");
        json_object_put(root);
        root = NULL;
    }
    json_tokener_free(parser);
    return root;
}

bool job_line_read(const char *text, size_t length, job_line *out, io_error *error) {
    line_reader r = {
        .inputs = growable_of(sizeof(char *)), .options = growable_of(sizeof(job_option)), .error = error};
    job_line line = {.memory = NULL};
    char *copy = malloc(length + 1);
    if (copy == NULL) return io_fail(error, "out of memory");
    memcpy(copy, text, length);
    copy[length] = '\0';
    r.root = parse_line(copy, length, error);
    free(copy);
    const bool good = r.root != NULL && read_members(&r, &line);
    if (!good) {
        growable_free(&r.inputs);
        growable_free(&r.options);
        json_object_put(r.root);
        return false;
    }
    line.input_count = r.inputs.count;
    line.option_count = r.options.count;
    line.inputs = growable_take(&r.inputs);
    line.options = growable_take(&r.options);
    line.memory = r.root;
    *out = line;
    return true;
}

void job_line_free(job_line *line) {
    free(line->inputs);
    free(line->options);
    json_object_put(line->memory);
    *line = (job_line){.memory = NULL};
}

/* ---- shards -------------------------------------------------------------------------------------------- */

bool read_shard(const char *text, void *place) {
    shard_choice shard;
    char index[16];
    const char *slash = strchr(text, '/');
    if (slash == NULL || (size_t)(slash - text) >= sizeof index) return false;
    memcpy(index, text, (size_t)(slash - text));
    index[slash - text] = '\0';
    if (!parse_unsigned(index, &shard.index) || !parse_unsigned(slash + 1, &shard.count)) return false;
    if (shard.index < 1 || shard.index > shard.count || shard.count > SHARD_COUNT_MAX) return false;
    *(shard_choice *)place = shard;
    return true;
}

/* ---- the shard with the least --------------------------------------------------------------------------- */

typedef struct shard_load {
    uint64_t size;
    uint32_t shard; /* from 0 */
} shard_load;

static bool load_less(const shard_load *a, const shard_load *b) {
    return a->size != b->size ? a->size < b->size : a->shard < b->shard;
}

/* Moves the first load of a heap, which has grown, to its place. */
static void sink_first(shard_load *heap, uint32_t count) {
    const shard_load moved = heap[0];
    uint32_t hole = 0;
    for (uint32_t child; (child = 2 * hole + 1) < count; hole = child) {
        if (child + 1 < count && load_less(&heap[child + 1], &heap[child])) child++;
        if (!load_less(&heap[child], &moved)) break;
        heap[hole] = heap[child];
    }
    heap[hole] = moved;
}

/* ---- jobs by size ---------------------------------------------------------------------------------------- */

typedef struct sized_job {
    uint64_t size;
    uint32_t job;
} sized_job;

/* The largest first. */
static int compare_sizes(const void *a, const void *b) {
    const sized_job *x = a, *y = b;
    if (x->size != y->size) return x->size > y->size ? -1 : 1;
    return x->job < y->job ? -1 : 1;
}

static void assign_sized(sized_job *sized, uint32_t count, shard_load *heap, uint32_t shard_count,
                         uint32_t *shards) {
    for (uint32_t i = 0; i < shard_count; i++) heap[i] = (shard_load){0, i};
    qsort(sized, count, sizeof *sized, compare_sizes);
    for (uint32_t i = 0; i < count; i++) {
        shards[sized[i].job] = heap[0].shard;
        heap[0].size += sized[i].size;
        sink_first(heap, shard_count);
    }
}

static uint32_t gather_sized(const job_list *list, uint32_t shard_count, sized_job *sized, uint32_t *shards) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        shards[i] = i % shard_count;
        if (list->jobs[i].size != NO_JOB_SIZE) sized[count++] = (sized_job){list->jobs[i].size, i};
    }
    return count;
}

bool job_shard_choose(const job_list *list, shard_choice shard, uint32_t **jobs, uint32_t *count,
                      io_error *error) {
    const uint32_t shard_count = shard.count > 0 ? shard.count : 1,
                   index = shard.count > 0 ? shard.index - 1 : 0;
    uint32_t *shards = malloc(list->count * sizeof *shards), *chosen = malloc(list->count * sizeof *chosen);
    sized_job *sized = malloc(list->count * sizeof *sized);
    shard_load *heap = malloc(shard_count * sizeof *heap);
    const bool good = (shards != NULL && chosen != NULL && sized != NULL && heap != NULL) ||
                      io_fail(error, "out of memory for %u jobs", list->count);
    *count = 0;
    if (good) {
        assign_sized(sized, gather_sized(list, shard_count, sized, shards), heap, shard_count, shards);
        for (uint32_t i = 0; i < list->count; i++)
            if (shards[i] == index) chosen[(*count)++] = i;
        *jobs = chosen;
    } else
        free(chosen);
    free(shards);
    free(sized);
    free(heap);
    return good;
}
