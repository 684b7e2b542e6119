/* When a run counts as failed (exit code 3): what --fail-on, --fail-depth and --max-faces say. */
#include "tool/answers/fail_rules.h"

#include "tool/common/command.h"
#include "tool/common/terminal.h"
#include "tool/io/text_encoding.h"

#include <stdio.h>
#include <string.h>

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
