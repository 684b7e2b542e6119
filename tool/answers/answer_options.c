/* The options about answers that check and replay have in common, lengths among them, and the rules by which
 * a run fails. */
#include "tool/answers/answers.h"

#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/terminal.h"
#include "tool/io/text_encoding.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- lengths and their units --------------------------------------------------------------------------- */

static const length_unit units[] = {{"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2},   {"dm", 0.1},
                                    {"m", 1.0},   {"km", 1e3},  {"in", 0.0254}, {"ft", 0.3048}};

bool length_unit_from_name(const char *text, length_unit *out) {
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(text, units[i].name) != 0) continue;
        *out = units[i];
        return true;
    }
    return false;
}

bool length_given_parse(const char *text, length_given *out) {
    const char *end;
    length_given length = {.given = true};
    if (!parse_decimal(text, &length.value, &end) || length.value < 0.0) return false;
    end += strspn(end, " ");
    if (*end != '\0' && !length_unit_from_name(end, &length.unit)) return false;
    *out = length;
    return true;
}

bool length_given_convert(const length_given *length, const length_unit *files, double *out,
                          io_error *error) {
    if (length->unit.name == NULL) {
        *out = length->value;
        return true;
    }
    if (files->name == NULL)
        return io_fail(error,
                       "%g %s: the files do not say what one unit of them is; say it with --unit mm, cm, m, "
                       "in or ft, or give the length without a unit",
                       length->value, length->unit.name);
    *out = length->value * length->unit.metres / files->metres;
    return true;
}

const char *length_text(double length, const length_unit *files, char text[LENGTH_TEXT_SIZE]) {
    if (files->name == NULL) {
        snprintf(text, LENGTH_TEXT_SIZE, "%.3g", length);
        return text;
    }
    if (strcmp(files->name, "in") == 0 || strcmp(files->name, "ft") == 0) {
        snprintf(text, LENGTH_TEXT_SIZE, "%.3g %s", length, files->name);
        return text;
    }
    static const char *const steps[] = {"um", "mm", "m", "km"};
    double metres = length * files->metres, scale = 1e-6;
    int step = 0;
    for (; step < 3 && fabs(metres) >= 0.9995 * scale * 1e3; step++) scale *= 1e3;
    snprintf(text, LENGTH_TEXT_SIZE, "%.3g %s", metres / scale, steps[step]);
    return text;
}

/* ---- rules --------------------------------------------------------------------------------------------- */

bool fail_rules_create(const fail_options *options, const length_unit *unit, fail_rules *out,
                       io_error *error) {
    fail_rules rules = {.options = *options, .unit = *unit};
    io_error reason;
    if (options->depth.given && !length_given_convert(&options->depth, unit, &rules.depth, &reason))
        return io_fail(error, "--fail-depth %s", reason.text);
    *out = rules;
    return true;
}

bool fail_rules_any(const fail_rules *rules) {
    const fail_options *o = &rules->options;
    return o->kind != FAIL_ON_NOTHING || o->depth.given || o->faces_limited;
}

enum { NAME_BYTES_MAX = 100 };

/* "A x B", of the worst that the frame has; "" if it has nothing. */
static void name_worst(const answers *a, const frame_answer *frame, char *text, size_t size) {
    text[0] = '\0';
    if (frame->worst_parts[0] == NO_PART) return;
    const char *first = part_names_at(a->parts, frame->worst_parts[0]);
    const char *second = part_names_at(a->parts, frame->worst_parts[1]);
    snprintf(text, size, ", worst: %.*s x %.*s", TEXT_CUT(first, NAME_BYTES_MAX),
             TEXT_CUT(second, NAME_BYTES_MAX));
}

/* Interiors that meet count as crossing, whether or not triangles do. */
static void describe_overlap(const frame_answer *frame, const char *worst, char text[FAIL_TEXT_SIZE]) {
    const char *what = frame->same > 0          ? "parts are copies of one solid"
                       : frame->overlapping > 0 ? "parts overlap"
                       : frame->inside == 1     ? "a part lies inside another"
                                                : "parts lie inside others";
    snprintf(text, FAIL_TEXT_SIZE, "%s, though no triangles cross%s", what, worst);
}

bool fail_rules_meet(const fail_rules *rules, const answers *a, const frame_answer *frame,
                     char text[FAIL_TEXT_SIZE]) {
    const fail_options *o = &rules->options;
    char worst[240], length[LENGTH_TEXT_SIZE];
    name_worst(a, frame, worst, sizeof worst);
    if (o->depth.given && frame->depth > rules->depth)
        snprintf(text, FAIL_TEXT_SIZE, "%s deep%s", length_text(frame->depth, &rules->unit, length), worst);
    else if (o->depth.given && frame->bound > rules->depth)
        snprintf(text, FAIL_TEXT_SIZE, "up to %s deep%s", length_text(frame->bound, &rules->unit, length),
                 worst);
    else if (o->depth.given && frame->same > 0)
        snprintf(text, FAIL_TEXT_SIZE, "parts are copies of one solid, and how deep is not known%s", worst);
    else if (o->faces_limited && frame->crossing_faces > o->most_faces)
        snprintf(text, FAIL_TEXT_SIZE, "%u triangles cross others%s", frame->crossing_faces, worst);
    else if (o->kind >= FAIL_ON_CROSSING && frame->crossing > 0)
        snprintf(text, FAIL_TEXT_SIZE, "%zu pair%s of triangles cross%s%s", frame->crossing,
                 frame->crossing > 1 ? "s" : "", frame->crossing > 1 ? "" : "es", worst);
    else if (o->kind >= FAIL_ON_CROSSING && frame_answer_crosses(frame))
        describe_overlap(frame, worst, text);
    else if (o->kind >= FAIL_ON_TOUCHING && frame->touching > 0)
        snprintf(text, FAIL_TEXT_SIZE, "%zu pair%s of triangles touch%s%s", frame->touching,
                 frame->touching > 1 ? "s" : "", frame->touching > 1 ? "" : "es", worst);
    else if (o->kind >= FAIL_ON_TOUCHING && frame->duplicates > 0)
        snprintf(text, FAIL_TEXT_SIZE, "%zu triangle%s there twice", frame->duplicates,
                 frame->duplicates > 1 ? "s are" : " is");
    else if (o->kind >= FAIL_ON_CONTACT && frame->contacts > 0)
        snprintf(text, FAIL_TEXT_SIZE, "%zu contact%s on the way to it", frame->contacts,
                 frame->contacts > 1 ? "s" : "");
    else
        return false;
    return true;
}

const char *fail_rules_unknown(const fail_rules *rules, const answers *a, const frame_answer *frame) {
    const fail_options *o = &rules->options;
    if (frame->without_area) return FAIL_WITHOUT_AREA;
    if (!frame->checked) return NULL;
    if (o->faces_limited && frame->unlisted)
        return "how many triangles cross others is not known, as a list of the pairs did not fit --max-memory";
    if (a->depths && !frame->spaces_known && (o->depth.given || o->kind >= FAIL_ON_CROSSING))
        return "how deep it is, and what lies inside, is not known, as that did not fit --max-memory or --max-work";
    return NULL;
}

bool fail_rules_undecided(const fail_rules *rules, const answers *a) {
    char text[FAIL_TEXT_SIZE];
    if (!fail_rules_any(rules) || answers_count(a, frame_answer_without_area) == 0) return false;
    for (size_t i = 0; i < answers_frame_count(a); i++)
        if (fail_rules_meet(rules, a, &answers_frames(a)[i], text)) return false;
    return true;
}

/* A gate passes nothing that nobody could look at. */
static int refuse_without_area(const answers *a) {
    const frame_answer *first = answers_frames(a);
    if (answers_single(a)) return fail_input("not decided: %s", FAIL_WITHOUT_AREA);
    while (!frame_answer_without_area(first)) first++;
    return fail_input(
        "not decided: in %zu of %zu frames, the first is frame %d, %s; --frames leaves frames out",
        answers_count(a, frame_answer_without_area), answers_frame_count(a),
        answers_frame_number(a, first->frame), FAIL_WITHOUT_AREA);
}

bool fail_rules_failed(const fail_rules *rules, const answers *a) {
    char text[FAIL_TEXT_SIZE], first[FAIL_TEXT_SIZE];
    size_t count = 0;
    const frame_answer *frames = answers_frames(a), *failed = NULL;
    for (size_t i = 0; i < answers_frame_count(a); i++) {
        if (!fail_rules_meet(rules, a, &frames[i], failed == NULL ? first : text)) continue;
        if (count++ == 0) failed = &frames[i];
    }
    if (count == 0) return false;
    if (answers_frame_count(a) == 1)
        note("failed: %s", first);
    else
        note("failed: %zu of %zu frames, the first is frame %d: %s", count, answers_frame_count(a),
             a->recording->frame_numbers[failed->frame], first);
    return true;
}

int fail_unfinished(const answers *a, bool printed, const char *reason) {
    const char *first = answers_unfinished(a);
    const bool said = printed && first != NULL && strcmp(first, reason) == 0;
    return said && terminal_outputs_are_one() ? EXIT_BAD_INPUT : fail_input("%s", reason);
}

int fail_rules_exit_code(const fail_rules *rules, const answers *a, bool printed) {
    if (fail_rules_failed(rules, a)) return EXIT_CONTACT;
    const char *unfinished = answers_unfinished(a);
    if (unfinished != NULL) return fail_unfinished(a, printed, unfinished);
    return fail_rules_undecided(rules, a) ? refuse_without_area(a) : EXIT_RAN;
}

/* ---- options ------------------------------------------------------------------------------------------- */

static bool read_unit(const char *text, void *place) {
    return length_unit_from_name(text, place);
}

static bool read_fail_depth(const char *text, void *place) {
    return length_given_parse(text, place);
}

static bool read_max_faces(const char *text, void *place) {
    fail_options *options = place;
    options->faces_limited = true;
    return parse_unsigned(text, &options->most_faces);
}

static bool read_orientation(const char *text, void *place) {
    int choice;
    if (!parse_choice(text, (const char *const[]){"found", "as-given"}, 2, &choice)) return false;
    *(bool *)place = choice == 1;
    return true;
}

static const option_row rows[] = {
    {"events", "OUT.csv", read_output_path, offsetof(answer_options, events_path),
     "write the events as a table: which parts, since when, how deep, where; - is the standard output"},
    {"junit", "OUT.xml", read_output_path, offsetof(answer_options, junit_path),
     "write a JUnit file for continuous integration: a test case for each frame"},
    {"fail-depth", "LENGTH", read_fail_depth, offsetof(answer_options, fail.depth),
     "exit with 3 when something is deeper than that: 2mm, or 0.002 in the files' unit"},
    {"max-faces", "N", read_max_faces, offsetof(answer_options, fail),
     "exit with 3 when more than N triangles cross others in one frame"},
    {"unit", "mm|cm|m|in|ft", read_unit, offsetof(answer_options, unit),
     "what one unit of the files is (default: metres of glTF files, else unknown)"},
    {"no-depths", NULL, read_flag, offsetof(answer_options, no_depths),
     "faster: find pairs and events, and neither how deep they are nor what lies inside"},
    {"orientation", "found|as-given", read_orientation, offsetof(answer_options, as_given),
     "found, the default: closed surfaces that are inside out are taken as turned around; as-given: they contain nothing"},
    {"max-memory", "SIZE", read_size, offsetof(answer_options, limits.memory),
     "what is found in one frame may take so much: 500M, 4G (default: a quarter of the memory that is free); what does not "
     "fit is left out, and said first"},
    {"max-work", "NUMBER", read_size, offsetof(answer_options, limits.work),
     "how deep it is in one frame may take so many comparisons: 1G, 16G (default: 256M, which take ten seconds or so); what "
     "would take more is left out, and said first"},
    {"timings", NULL, read_flag, offsetof(answer_options, timings),
     "print more: how long it took, and a row for each frame that is not clean"},
};

const option_list answer_rows = {"Answers:", rows, sizeof rows / sizeof *rows};

bool answer_options_agree(const answer_options *o, io_error *error) {
    if (!o->no_depths) return true;
    if (o->fail.depth.given) return io_fail(error, "--fail-depth needs depths, which --no-depths leaves out");
    return o->fail.kind == FAIL_ON_NOTHING ||
           io_fail(error, "--fail-on counts what lies inside, too, which --no-depths does not look at");
}

length_unit answer_options_unit(const answer_options *o, const recording *r) {
    length_unit unit = o->unit;
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].file.format != MESH_FORMAT_GLTF) return unit;
    if (unit.name == NULL) length_unit_from_name("m", &unit);
    return unit;
}

static bool open_file(const char *path, output_file *out, io_error *error) {
    return path == NULL || output_file_open(path, out) || io_fail_write(error, path);
}

bool answer_outputs_open(const answer_options *o, answer_outputs *out, io_error *error) {
    *out = (answer_outputs){.options = o};
    return open_file(o->events_path, &out->events, error) && open_file(o->junit_path, &out->junit, error);
}

static bool close_file(const char *path, output_file *file, output_ending ending, io_error *error) {
    if (file->file == NULL || output_file_close(file, ending) || ending == OUTPUT_ABANDONED) return true;
    return io_fail_write(error, path);
}

bool answer_outputs_close(answer_outputs *outputs, const answers *a, const fail_rules *rules,
                          const char *suite, io_error *error) {
    const answer_options *o = outputs->options;
    if (o == NULL) return true;
    const output_ending ending = a != NULL ? OUTPUT_WHOLE : OUTPUT_ABANDONED;
    if (a != NULL && outputs->events.file != NULL) answers_write_csv(a, outputs->events.file);
    if (a != NULL && outputs->junit.file != NULL) answers_write_junit(a, rules, suite, outputs->junit.file);
    bool written = close_file(o->events_path, &outputs->events, ending, error);
    written = close_file(o->junit_path, &outputs->junit, ending, written ? error : NULL) && written;
    *outputs = (answer_outputs){0};
    return written;
}
