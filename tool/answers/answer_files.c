/* The answers as files: members of a JSON object, a CSV file of the events, and a JUnit file for continuous
 * integration. */
#include "tool/answers/answers.h"

#include "tool/io/record.h"
#include "tool/io/text_encoding.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* ---- events --------------------------------------------------------------------------------------------- */

/* An event as its fields have it: frames have the artist's numbers, triangles and faces those of their model
 * files. */
typedef struct event_row {
    const char *a, *b, *object;
    int32_t first, last, worst;
    record_words kinds;
    uint64_t pairs, contacts;
    double depth, length, point[3];
    uint32_t triangle, face;
} event_row;

#define FIELD_OF(member) offsetof(event_row, member)

/* Columns and members of an event. */
static const record_field event_fields[] = {
    {"a", "a", RECORD_NAME, FIELD_OF(a)},
    {"b", "b", RECORD_NAME, FIELD_OF(b)},
    {"first", "first", RECORD_SIGNED, FIELD_OF(first)},
    {"last", "last", RECORD_SIGNED, FIELD_OF(last)},
    {"worst", "worst", RECORD_SIGNED, FIELD_OF(worst)},
    {"kinds", "kinds", RECORD_WORDS, FIELD_OF(kinds)},
    {"pairs", "pairs", RECORD_COUNT, FIELD_OF(pairs)},
    {"contacts", "contacts", RECORD_COUNT, FIELD_OF(contacts)},
    {"depth", "depth", RECORD_NUMBER, FIELD_OF(depth)},
    {"length", "length", RECORD_NUMBER, FIELD_OF(length)},
    {"x,y,z", "point", RECORD_VECTOR, FIELD_OF(point)},
    {"triangle", "triangle", RECORD_INDEX, FIELD_OF(triangle)},
    {"face", "face", RECORD_INDEX, FIELD_OF(face)},
    {"object", "object", RECORD_NAME, FIELD_OF(object)},
};

enum { EVENT_FIELDS = sizeof event_fields / sizeof *event_fields };

static record_words words_of_kinds(uint64_t kinds) {
    record_words words = {.count = 0};
    for (int kind = CSCD_INTERSECTION_CROSSING; kind <= CSCD_INTERSECTION_TOUCHING; kind++)
        if (kinds & cscd_intersection_set((cscd_intersection_kind)kind))
            words.items[words.count++] = cscd_intersection_kind_name((cscd_intersection_kind)kind);
    if (kinds & CSCD_EVENT_SAME_SOLID) words.items[words.count++] = "same_solid";
    return words;
}

static event_row row_of(const answers *a, const cscd_event *event) {
    const recording *r = a->recording;
    event_row row = {.a = part_names_at(a->parts, event->a),
                     .b = part_names_at(a->parts, event->b),
                     .first = answers_frame_number(a, event->first_frame),
                     .last = answers_frame_number(a, event->last_frame),
                     .worst = answers_frame_number(a, event->worst_frame),
                     .kinds = words_of_kinds(event->kinds),
                     .pairs = event->pairs,
                     .contacts = event->contacts,
                     .depth = answers_event_depth_known(a, event) ? event->depth : (double)NAN,
                     .length = event->length,
                     .point = {event->x[0], event->x[1], event->x[2]},
                     .triangle = event->triangle,
                     .face = event->triangle};
    if (event->triangle == UINT32_MAX) return row;
    row.triangle = recording_file_triangle(r, event->triangle);
    row.face = recording_file_face(r, event->triangle);
    row.object = r->objects[recording_object_of_triangle(r, event->triangle)].source.name;
    return row;
}

/* ---- JSON ----------------------------------------------------------------------------------------------- */

static void write_event(const answers *a, const cscd_event *event, json *out) {
    const event_row row = row_of(a, event);
    json_break_line(out);
    json_begin_object(out, NULL);
    record_write_members(out, event_fields, EVENT_FIELDS, &row);
    json_end_object(out);
}

static void write_spans(const answers *a, const char *name, const frame_list *list, json *out) {
    const frame_answer *frames = answers_frames(a);
    json_begin_array(out, name);
    for (uint32_t i = 0; i < list->count; i++) {
        json_begin_array(out, NULL);
        json_signed(out, NULL, answers_frame_number(a, frames[list->spans[i].first].frame));
        json_signed(out, NULL, answers_frame_number(a, frames[list->spans[i].last].frame));
        json_end_array(out);
    }
    json_end_array(out);
}

/* The parts without a surface, and their frames. */
static void write_collapsed(const answers *a, json *out) {
    json_begin_array(out, "collapsed");
    for (uint32_t i = 0; i < a->parts->count; i++) {
        const collapsed_part *frames = collapsed_parts_at(&a->collapsed, i);
        if (frames == NULL) continue;
        json_begin_object(out, NULL);
        json_string(out, "part", part_names_at(a->parts, i));
        write_spans(a, "whole", &frames->whole, out);
        write_spans(a, "partly", &frames->partly, out);
        json_end_object(out);
    }
    json_end_array(out);
}

/* Pairs that were not looked at because somebody asked for that: all else is true except of these. */
static void write_left_out(const answers *a, json *out) {
    const ignore_counts counts = ignore_pairs_count(a->shown.ignored);
    json_begin_object(out, "left_out");
    json_integer(out, "part_pairs", counts.parts);
    json_integer(out, "of_part_pairs", counts.all_parts);
    json_integer(out, "component_pairs", counts.components);
    json_integer(out, "triangle_pairs", counts.triangles);
    json_end_object(out);
}

void answers_write_json(const answers *a, const length_unit *unit, json *out) {
    if (unit->name != NULL)
        json_string(out, "unit", unit->name);
    else
        json_null(out, "unit");
    json_begin_array(out, "events");
    for (size_t i = 0; i < a->event_count; i++) write_event(a, &a->events[i], out);
    json_end_array(out);
    json_break_line(out);
    turned_parts_write(&a->turned, out);
    write_collapsed(a, out);
    write_left_out(a, out);
}

/* A value that nobody has looked at is null. */
static void write_known(json *out, const frame_answer *frame, const char *name, double number) {
    if (frame->spaces_known)
        json_number(out, name, number);
    else
        json_null(out, name);
}

void answers_write_frame(const answers *a, const frame_answer *frame, json *out) {
    const uint32_t triangles = cscd_mesh_triangle_count(a->recording->mesh);
    json_boolean(out, "crossing", frame->crossing > 0);
    if (frame_answer_clean(frame) && !frame->spaces_known)
        json_null(out, "clean");
    else
        json_boolean(out, "clean", frame_answer_clean(frame));
    write_known(out, frame, "overlapping_parts", (double)frame->overlapping);
    write_known(out, frame, "inside_parts", (double)frame->inside);
    write_known(out, frame, "same_solids", (double)frame->same);
    json_integer(out, "crossing_pairs", frame->crossing);
    json_integer(out, "touching_pairs", frame->touching);
    json_integer(out, "duplicate_pairs", frame->duplicates);
    if (frame->unlisted) {
        json_null(out, "crossing_faces");
        json_null(out, "crossing_share");
    } else {
        json_integer(out, "crossing_faces", frame->crossing_faces);
        json_number(out, "crossing_share", triangles > 0 ? (double)frame->crossing_faces / triangles : 0.0);
    }
    write_known(out, frame, "depth", frame->depth);
}

/* ---- CSV ------------------------------------------------------------------------------------------------ */

void answers_write_csv(const answers *a, FILE *file) {
    record_write_header(file, event_fields, EVENT_FIELDS);
    for (size_t i = 0; i < a->event_count; i++) {
        const event_row row = row_of(a, &a->events[i]);
        record_write_row(file, event_fields, EVENT_FIELDS, &row);
    }
}

/* ---- JUnit ---------------------------------------------------------------------------------------------- */

/* Without rules a frame fails that crosses. */
static fail_rules rules_of_cases(const fail_rules *rules) {
    fail_rules own = *rules;
    if (!fail_rules_any(rules)) own.options.kind = FAIL_ON_CROSSING;
    return own;
}

/* The reason why a frame neither fails nor passes; NULL: it does. */
static const char *why_undecided(const answers *a, const fail_rules *rules, const frame_answer *frame) {
    char text[FAIL_TEXT_SIZE];
    return fail_rules_meet(rules, a, frame, text) ? NULL : fail_rules_unknown(rules, a, frame);
}

static void write_case(const answers *a, const fail_rules *rules, const frame_answer *frame, FILE *file) {
    char text[FAIL_TEXT_SIZE];
    const bool fails = fail_rules_meet(rules, a, frame, text);
    const char *unknown = fails ? NULL : fail_rules_unknown(rules, a, frame);
    fprintf(file, "    <testcase classname=\"cscd\" name=\"frame %" PRId32 "\" time=\"%.6f\"",
            answers_frame_number(a, frame->frame), frame->ms * 1e-3);
    if (!fails && unknown == NULL) {
        fputs("/>\n", file);
        return;
    }
    fprintf(file, ">\n      <%s message=\"", fails ? "failure" : "error");
    text_write_xml(file, fails ? text : unknown);
    fputs("\"/>\n    </testcase>\n", file);
}

/* Anything that was not looked at is an error, and a test case of its own. */
static void write_unfinished(const char *reason, FILE *file) {
    fputs(
        "    <testcase classname=\"cscd\" name=\"all was looked at\" time=\"0\">\n      <error message=\"Not finished: ",
        file);
    text_write_xml(file, reason);
    fputs("\"/>\n    </testcase>\n", file);
}

void answers_write_junit(const answers *a, const fail_rules *given, const char *suite, FILE *file) {
    const fail_rules own = rules_of_cases(given), *rules = &own;
    const frame_answer *frames = answers_frames(a);
    const char *unfinished = answers_unfinished(a);
    char text[FAIL_TEXT_SIZE];
    size_t tests = unfinished != NULL, failures = 0, errors = tests;
    double ms = 0.0;
    for (size_t i = 0; i < answers_frame_count(a); i++) {
        tests++;
        failures += fail_rules_meet(rules, a, &frames[i], text);
        errors += why_undecided(a, rules, &frames[i]) != NULL;
        ms += frames[i].ms;
    }
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"", file);
    text_write_xml(file, suite);
    fprintf(file, "\" tests=\"%zu\" failures=\"%zu\" errors=\"%zu\" time=\"%.6f\">\n", tests, failures,
            errors, ms * 1e-3);
    for (size_t i = 0; i < answers_frame_count(a); i++) write_case(a, rules, &frames[i], file);
    if (unfinished != NULL) write_unfinished(unfinished, file);
    fputs("  </testsuite>\n</testsuites>\n", file);
}
