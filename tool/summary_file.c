/* Reads back what `cscd replay --json` wrote. */
#include "tool/tool.h"

#include "tool/common/methods.h"
#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/io/text_encoding.h"

#include <errno.h>
#include <json-c/json.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A member that must be there, and what it must be: n: number, i: whole number, N: number or null, s: string,
 * S: string or null, a: array, A: array or null, o: object, b: true or false. */
typedef struct member {
    const char *name;
    char kind;
} member;

static const member of_interval[] = {{"frame", 'i'}, {"vf", 'n'},        {"ee", 'n'},   {"earliest_toi", 'N'},
                                     {"pcp", 'n'},   {"tests", 'n'},     {"plus", 'n'}, {"minus", 'n'},
                                     {"state", 's'}, {"guarantee", 'a'}, {NULL, 0}};
static const member of_guarantee[] = {{"mode", 's'}, {"reason", 's'}, {NULL, 0}};
static const member of_guarantee_group[] = {{"count", 'n'}, {NULL, 0}};
static const member of_exceptions[] = {{"components", 'a'}, {NULL, 0}};
static const member of_frame[] = {{"frame", 'n'}, {NULL, 0}};
static const member of_summary[] = {{"complete", 'b'},
                                    {"method", 's'},
                                    {"mode", 's'},
                                    {"volume", 's'},
                                    {"min_separation", 'n'},
                                    {"plan", 'o'},
                                    {"vertices", 'n'},
                                    {"triangles", 'n'},
                                    {"components", 'n'},
                                    {"intervals", 'n'},
                                    {"intervals_complete", 'n'},
                                    {"intervals_with_contact", 'n'},
                                    {"frames_checked", 'n'},
                                    {"frames_crossing", 'n'},
                                    {"contradictions", 'n'},
                                    {"vf", 'n'},
                                    {"ee", 'n'},
                                    {NULL, 0}};
static const member of_plan[] = {{"source", 's'}, {"method", 's'}, {"regions", 'n'}, {NULL, 0}};
/* The members that --reproducible leaves out, with the times of all stages. */
static const member of_timed_interval[] = {{"ms", 'o'}, {NULL, 0}};
static const member of_timed_summary[] = {{"simd", 's'}, {NULL, 0}};
static const member of_timed_plan[] = {{"made_ms", 'n'}, {NULL, 0}};
static const member of_timed_provenance[] = {
    {"date", 's'}, {"machine", 'o'}, {"threads", 'n'}, {"arguments", 'a'}, {NULL, 0}};
static const member of_incomplete[] = {{"stopped_by", 's'}, {NULL, 0}};
static const member of_column[] = {{"mean", 'n'}, {"max", 'n'}, {NULL, 0}};
static const member of_provenance[] = {{"version", 's'}, {"commit", 's'}, {"compiler", 's'},
                                       {"flags", 's'},   {"inputs", 'a'}, {NULL, 0}};
static const member of_machine[] = {{"system", 's'},    {"release", 's'},    {"architecture", 's'},
                                    {"processor", 's'}, {"processors", 'n'}, {NULL, 0}};
static const member of_event[] = {{"a", 's'},     {"b", 's'},      {"first", 'i'}, {"last", 'i'},
                                  {"worst", 'i'}, {"kinds", 'a'},  {"pairs", 'n'}, {"contacts", 'n'},
                                  {"depth", 'n'}, {"length", 'n'}, {"point", 'A'}, {"triangle", 'N'},
                                  {"face", 'N'},  {"object", 'S'}, {NULL, 0}};
static const member of_unit[] = {{"unit", 'S'}, {NULL, 0}};
static const member of_input[] = {{"name", 's'}, {"fnv1a64", 's'}, {NULL, 0}};
/* The counters whose mean and maximum the page shows, beside those of all stages. */
static const char *const counted_columns[] = {"pcp", "tests"};

static bool is_of_kind(json_object *value, char kind) {
    enum json_type type = json_object_get_type(value);
    switch (kind) {
    case 'n':
        return type == json_type_int || type == json_type_double;
    case 'i':
        return type == json_type_int;
    case 's':
        return type == json_type_string;
    case 'S':
        return type == json_type_string || type == json_type_null;
    case 'a':
        return type == json_type_array;
    case 'A':
        return type == json_type_array || type == json_type_null;
    case 'o':
        return type == json_type_object;
    case 'b':
        return type == json_type_boolean;
    default:
        return type == json_type_int || type == json_type_double || type == json_type_null;
    }
}

/* NULL: not there, or null. */
static json_object *find_member(json_object *object, const char *name) {
    return json_object_is_type(object, json_type_object) ? json_object_object_get(object, name) : NULL;
}

/* where: the object, in words. */
static bool has_members(json_object *object, const member *members, const char *where, io_error *error) {
    for (const member *m = members; m->name != NULL; m++) {
        json_object *value = NULL;
        if (!json_object_is_type(object, json_type_object) ||
            !json_object_object_get_ex(object, m->name, &value))
            return io_fail(error, "%s has no member '%s'", where, m->name);
        if (!is_of_kind(value, m->kind))
            return io_fail(error, "%s: '%s' is not what cscd writes there", where, m->name);
    }
    return true;
}

static bool elements_have(json_object *array, const member *members, const char *where, io_error *error) {
    for (size_t i = 0; i < json_object_array_length(array); i++)
        if (!has_members(json_object_array_get_idx(array, i), members, where, error)) return false;
    return true;
}

static bool has_times(json_object *times, const char *where, io_error *error) {
    for (int i = 0; i < TIMING_COUNT; i++) {
        const member of_stage[] = {{timing_rows[i].name, 'n'}, {NULL, 0}};
        if (!has_members(times, of_stage, where, error)) return false;
    }
    return true;
}

static bool is_state(const char *name) {
    for (interval_state state = INTERVAL_CLEAN; state < INTERVAL_STATES; state++)
        if (strcmp(name, interval_state_name(state)) == 0) return true;
    return false;
}

/* One object per component, as version 1 has it, or per group of components, of which the first names
 * none. */
static bool check_guarantees(json_object *guarantees, const char *where, io_error *error) {
    if (!elements_have(guarantees, of_guarantee, where, error)) return false;
    for (size_t i = 0; i < json_object_array_length(guarantees); i++) {
        json_object *group = json_object_array_get_idx(guarantees, i);
        if (find_member(group, "component") != NULL) continue;
        if (!has_members(group, of_guarantee_group, where, error) ||
            (i > 0 && !has_members(group, of_exceptions, where, error)))
            return false;
    }
    return true;
}

static bool check_interval(json_object *interval, size_t index, bool timed, io_error *error) {
    char where[48];
    snprintf(where, sizeof where, "interval %zu of the file", index);
    if (!has_members(interval, of_interval, where, error)) return false;
    if (!is_state(json_object_get_string(find_member(interval, "state"))))
        return io_fail(error, "%s: 'state' is not what cscd writes there", where);
    if (timed && (!has_members(interval, of_timed_interval, where, error) ||
                  !has_times(find_member(interval, "ms"), where, error)))
        return false;
    return check_guarantees(find_member(interval, "guarantee"), where, error);
}

/* Frames ascend, by the numbers that their recording gives them. */
static bool check_intervals(json_object *intervals, bool timed, io_error *error) {
    int64_t before = 0;
    for (size_t i = 0; i < json_object_array_length(intervals); i++) {
        json_object *interval = json_object_array_get_idx(intervals, i);
        if (!check_interval(interval, i, timed, error)) return false;
        int64_t frame = json_object_get_int64(find_member(interval, "frame"));
        if (frame < INT32_MIN || frame > INT32_MAX || (i > 0 && frame <= before))
            return io_fail(error, "interval %zu of the file: 'frame' is not what cscd writes there", i);
        before = frame;
    }
    return true;
}

static bool check_column(json_object *summary, const char *name, io_error *error) {
    char where[64];
    snprintf(where, sizeof where, "'%s' of the summary", name);
    return has_members(find_member(summary, name), of_column, where, error);
}

static bool check_columns(json_object *summary, bool timed, io_error *error) {
    for (int i = 0; i < TIMING_COUNT && timed; i++) {
        char name[32];
        snprintf(name, sizeof name, "%s_ms", timing_rows[i].name);
        if (!check_column(summary, name, error)) return false;
    }
    for (size_t i = 0; i < sizeof counted_columns / sizeof *counted_columns; i++)
        if (!check_column(summary, counted_columns[i], error)) return false;
    return true;
}

static bool strings_only(json_object *array, const char *where, io_error *error) {
    for (size_t i = 0; i < json_object_array_length(array); i++)
        if (!json_object_is_type(json_object_array_get_idx(array, i), json_type_string))
            return io_fail(error, "%s are not what cscd writes there", where);
    return true;
}

static bool numbers_only(json_object *array, const char *where, io_error *error) {
    for (size_t i = 0; i < json_object_array_length(array); i++)
        if (!is_of_kind(json_object_array_get_idx(array, i), 'n'))
            return io_fail(error, "%s are not what cscd writes there", where);
    return true;
}

static bool check_event(json_object *event, size_t index, io_error *error) {
    char where[48], what[96];
    snprintf(where, sizeof where, "event %zu of the file", index);
    if (!has_members(event, of_event, where, error)) return false;
    int64_t first = json_object_get_int64(find_member(event, "first"));
    int64_t last = json_object_get_int64(find_member(event, "last"));
    int64_t worst = json_object_get_int64(find_member(event, "worst"));
    if (first < INT32_MIN || last > INT32_MAX || worst < first || worst > last)
        return io_fail(error, "%s: its frames are not what cscd writes there", where);
    json_object *point = find_member(event, "point");
    snprintf(what, sizeof what, "%s: the coordinates", where);
    if (point != NULL && (json_object_array_length(point) != 3 || !numbers_only(point, what, error)))
        return io_fail(error, "%s are not what cscd writes there", what);
    snprintf(what, sizeof what, "%s: its kinds", where);
    return strings_only(find_member(event, "kinds"), what, error);
}

/* Summaries of older versions have no events: that is fine. */
static bool check_events(json_object *root, io_error *error) {
    json_object *events = NULL;
    if (!json_object_object_get_ex(root, "events", &events)) return true;
    if (!json_object_is_type(events, json_type_array))
        return io_fail(error, "the file: 'events' is not what cscd writes there");
    for (size_t i = 0; i < json_object_array_length(events); i++)
        if (!check_event(json_object_array_get_idx(events, i), i, error)) return false;
    return has_members(root, of_unit, "the file", error);
}

/* The members that --reproducible leaves out are all there, or none is. */
static bool check_moment(json_object *summary, json_object *provenance, io_error *error) {
    return has_members(summary, of_timed_summary, "the summary", error) &&
           has_members(find_member(summary, "plan"), of_timed_plan, "the plan", error) &&
           has_members(provenance, of_timed_provenance, "the provenance", error) &&
           has_members(find_member(provenance, "machine"), of_machine, "the machine", error) &&
           strings_only(find_member(provenance, "arguments"), "the arguments", error);
}

static bool check_summary(json_object *root, io_error *error) {
    static const member parts[] = {
        {"intervals", 'a'}, {"frames", 'a'}, {"summary", 'o'}, {"provenance", 'o'}, {NULL, 0}};
    if (!has_members(root, parts, "the file", error)) return false;
    json_object *summary = find_member(root, "summary"), *provenance = find_member(root, "provenance");
    const bool timed = find_member(summary, "total_ms") != NULL || find_member(provenance, "date") != NULL;
    return check_intervals(find_member(root, "intervals"), timed, error) &&
           elements_have(find_member(root, "frames"), of_frame, "a frame", error) &&
           check_events(root, error) && has_members(summary, of_summary, "the summary", error) &&
           check_columns(summary, timed, error) &&
           has_members(find_member(summary, "plan"), of_plan, "the plan", error) &&
           (json_object_get_boolean(find_member(summary, "complete")) ||
            has_members(summary, of_incomplete, "the summary", error)) &&
           has_members(provenance, of_provenance, "the provenance", error) &&
           elements_have(find_member(provenance, "inputs"), of_input, "an input", error) &&
           (!timed || check_moment(summary, provenance, error));
}

/* Reads the whole file and ends it with a 0, which *size does not count; NULL with the reason. */
static char *read_text(const char *path, size_t *size, io_error *error) {
    FILE *file = pipe_file_read(path);
    char *text = NULL, buffer[65536];
    size_t length = 0;
    FILE *memory = open_memstream(&text, &length);
    bool whole = file != NULL && memory != NULL;
    if (file == NULL)
        io_fail(error, "%s: cannot open: %s", path, strerror(errno));
    else if (memory == NULL)
        io_fail(error, "%s: out of memory", path);
    for (size_t count; whole && (count = fread(buffer, 1, sizeof buffer, file)) > 0;)
        whole = fwrite(buffer, 1, count, memory) == count || io_fail(error, "%s: out of memory", path);
    if (whole && ferror(file)) whole = io_fail(error, "%s: cannot read: %s", path, strerror(errno));
    if (file != NULL) fclose(file);
    if (memory != NULL && fclose(memory) != 0 && whole) whole = io_fail(error, "%s: out of memory", path);
    *size = length;
    if (whole) return text;
    free(text);
    return NULL;
}

static int line_of(const char *text, size_t place) {
    int line = 1;
    for (size_t i = 0; i < place; i++) line += text[i] == '\n';
    return line;
}

/* NULL with the reason. */
static json_object *parse_text(const char *path, const char *text, size_t size, io_error *error) {
    static const char expected[] = "expected what cscd replay --json wrote, to its end";
    if (!json_has_room(text, size)) {
        io_fail(error, "%s: more objects than one in ten bytes; %s", path, expected);
        return NULL;
    }
    struct json_tokener *tokener = size <= INT_MAX ? json_tokener_new() : NULL;
    if (tokener == NULL) {
        io_fail(error, "%s: %s", path, size <= INT_MAX ? "out of memory" : "more than 2 GB");
        return NULL;
    }
    json_tokener_set_flags(tokener, JSON_TOKENER_STRICT | JSON_TOKENER_VALIDATE_UTF8);
    const size_t mark = text_mark_size(text, size);
    json_object *root = json_tokener_parse_ex(tokener, text + mark, (int)(size - mark));
    size_t end = mark + json_tokener_get_parse_end(tokener);
    if (root == NULL && text_is_utf16(text, size)) {
        io_fail(error, "%s: " TEXT_UTF16_ADVICE, path);
    } else if (root == NULL) {
        enum json_tokener_error reason = json_tokener_get_error(tokener);
        io_fail(error, "%s:%d: %s; %s", path, line_of(text, end < size ? end : size),
                reason == json_tokener_continue ? "the file ends too early" : json_tokener_error_desc(reason),
                expected);
    }
    json_tokener_free(tokener);
    return root;
}

/* Makes numbers those of JSON: json-c also reads "1." and NaN, and would write them so. */
static bool numbers_are_plain(json_object *value) {
    switch (json_object_get_type(value)) {
    case json_type_double:
        json_object_set_serializer(value, NULL, NULL, NULL);
        return isfinite(json_object_get_double(value));
    case json_type_array:
        for (size_t i = 0; i < json_object_array_length(value); i++)
            if (!numbers_are_plain(json_object_array_get_idx(value, i))) return false;
        return true;
    case json_type_object: {
        json_object_object_foreach(value, name, inner) {
            (void)name;
            if (!numbers_are_plain(inner)) return false;
        }
        return true;
    }
    default:
        return true;
    }
}

/* Writes the checked text again, as strictly as a browser requires it; NULL with the reason. */
static char *checked_text(const char *path, json_object *root, io_error *error) {
    static const char expected[] = "expected what cscd replay --json wrote";
    io_error reason;
    char *copy = NULL;
    if (!check_summary(root, &reason)) {
        io_fail(error, "%s: %s; %s", path, reason.text, expected);
    } else if (!numbers_are_plain(root)) {
        io_fail(error, "%s: a number is not finite; %s", path, expected);
    } else {
        const char *plain =
            json_object_to_json_string_ext(root, JSON_C_TO_STRING_PLAIN | JSON_C_TO_STRING_NOSLASHESCAPE);
        copy = plain != NULL ? strdup(plain) : NULL;
        if (copy == NULL) io_fail(error, "%s: out of memory", path);
    }
    return copy;
}

char *summary_file_read(const char *path, io_error *error) {
    size_t size = 0;
    char *text = read_text(path, &size, error), *checked = NULL;
    json_object *root = text != NULL ? parse_text(path, text, size, error) : NULL;
    if (root != NULL) checked = checked_text(path, root, error);
    json_object_put(root);
    free(text);
    return checked;
}
