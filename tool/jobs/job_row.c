/* Reads from a line of results what a page says of its job. */
#include "tool/jobs/job_row.h"

#include <json-c/json.h>
#include <limits.h>
#include <math.h>

/* The text of the first of two members that is one. */
static const char *find_text(json_object *line, const char *name, const char *other) {
    json_object *value = json_object_object_get(line, name);
    if (!json_object_is_type(value, json_type_string)) value = json_object_object_get(line, other);
    const char *text = json_object_is_type(value, json_type_string) ? json_object_get_string(value) : NULL;
    return text != NULL ? text : "";
}

static double find_number(json_object *line, const char *name, const char *other) {
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
        .name = find_text(line, "name", "file"),
        .answer = find_text(line, "error", "answer"),
        .report = find_text(line, "report", "report"),
        .frames = find_number(line, "frames_checked", "frames"),
        .crossing_frames = find_number(line, "frames_crossing", "frames_crossing"),
        .events = find_number(line, "events", "events"),
        .depth = find_number(line, "depth", "depth"),
        .crossing_pairs = find_number(line, "crossing_pairs", "crossing"),
        .seconds =
            1e-3 * (find_number(line, "read_ms", "read_ms") + find_number(line, "check_ms", "check_ms")),
        .memory = line,
    };
    return true;
}

void job_row_free(job_row *row) {
    json_object_put(row->memory);
    *row = (job_row){.memory = NULL};
}
