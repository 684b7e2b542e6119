/* Writes results of jobs as JUnit's XML. */
#include "tool/jobs/job_junit.h"

#include "tool/io/text_escape.h"

#include <json-c/json.h>

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
