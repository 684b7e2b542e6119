/* What every line of results begins with, and the sums of many lines. */
#include "tool/jobs/job_record.h"

#include "tool/io/json_room.h"

#include <inttypes.h>
#include <json-c/json.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

static const char *const outcome_names[JOB_OUTCOMES] = {"clean",     "crossing", "touching",
                                                        "duplicate", "inside",   "failed"};

const char *job_outcome_name(job_outcome outcome) {
    return outcome_names[outcome];
}

void job_record_write(json *line, const job_record *r) {
    char digits[17];
    snprintf(digits, sizeof digits, "%016" PRIx64, r->list);
    json_begin_object(line, NULL);
    json_string(line, "list", digits);
    json_integer(line, "jobs", r->jobs);
    json_integer(line, "job", (uint64_t)r->job + 1);
    json_string(line, "result", job_outcome_name(r->outcome));
    json_boolean(line, "found", r->found);
}

bool job_record_begins(const char *text, size_t length, uint64_t list, uint32_t jobs) {
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
