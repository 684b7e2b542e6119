/* The answers for people: a sentence first, then the events, the worst first. */
#include "src/tool/answers/answer_words.h"

#include <string.h>

enum { SPANS_SAID = 6, EVENTS_SHOWN = 20, NAME_WIDTH_MAX = 60 };

#define CROSSING cscd_intersection_set(CSCD_INTERSECTION_CROSSING)

/* Is there one frame, and was no other one asked for? */
static bool is_single(const answers *a) {
    return answers_frame_count(a) == 1 && a->wanted <= 1;
}

typedef bool frame_test(const frame_answer *frame);

static bool frame_checked(const frame_answer *frame) {
    return frame->checked;
}

static bool frame_overlaps(const frame_answer *frame) {
    return frame->crossing == 0 && frame_answer_crosses(frame);
}

static bool frame_touches(const frame_answer *frame) {
    return !frame_answer_crosses(frame) && frame->touching > 0;
}

static size_t count_frames(const answers *a, frame_test *test) {
    size_t count = 0;
    for (size_t i = 0; i < answers_frame_count(a); i++) count += test(&answers_frames(a)[i]);
    return count;
}

/* Prints "17 to 43, 45, 47 to 48": the frames that pass, in their order. Frames that follow each other in what was looked
 * at make a range. */
static void say_frames(FILE *out, const answers *a, frame_test *test) {
    const frame_answer *frames = answers_frames(a);
    size_t spans = 0;
    for (size_t i = 0, end; i < answers_frame_count(a); i = end) {
        end = i + 1;
        if (!test(&frames[i])) continue;
        while (end < answers_frame_count(a) && test(&frames[end])) end++;
        if (++spans > SPANS_SAID) {
            fprintf(out, " and others");
            return;
        }
        fprintf(out, "%s%d", spans > 1 ? ", " : " ", answers_frame_number(a, frames[i].frame));
        if (end - i > 1) fprintf(out, " to %d", answers_frame_number(a, frames[end - 1].frame));
    }
}

/* ---- names ------------------------------------------------------------------------------------------- */

/* Columns that a text takes in a terminal, but for wide characters: characters, not bytes. */
static int text_width(const char *text) {
    int width = 0;
    for (; *text != '\0'; text++) width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

/* "A x B", or "A x itself". */
static const char *second_name(const answers *a, uint32_t first, uint32_t second) {
    return first == second ? "itself" : part_names_at(a->parts, second);
}

static int pair_width(const answers *a, uint32_t first, uint32_t second) {
    return text_width(part_names_at(a->parts, first)) + 3 + text_width(second_name(a, first, second));
}

/* Filled with blanks. */
static void print_pair(FILE *out, const answers *a, uint32_t first, uint32_t second, int width) {
    fprintf(out, "%s x %s", part_names_at(a->parts, first), second_name(a, first, second));
    fprintf(out, "%*s", width > pair_width(a, first, second) ? width - pair_width(a, first, second) : 0, "");
}

/* ---- the sentence --------------------------------------------------------------------------------------- */

static void say_recording(FILE *out, const answers *a) {
    const size_t checked = count_frames(a, frame_checked);
    const size_t crossing = count_frames(a, frame_answer_crosses), touching = count_frames(a, frame_touches);
    const char *more = count_frames(a, frame_overlaps) > 0 ? " or overlap" : "";
    if (checked == 0)
        fprintf(out, "No frame was checked.");
    else if (crossing == checked)
        fprintf(out, "All %zu frames cross%s.", checked, more);
    else if (crossing > 0) {
        fprintf(out, "Frame%s", crossing > 1 ? "s" : "");
        say_frames(out, a, frame_answer_crosses);
        fprintf(out, " cross%s%s%s (%zu of %zu)", crossing > 1 ? "" : "es", more,
                crossing > 1 || *more == '\0' ? "" : "s", crossing, checked);
        if (touching == 0) fprintf(out, ".");
    } else
        fprintf(out, touching > 0 ? "No frame crosses" : "No frame crosses or touches (%zu checked).",
                checked);
    if (touching > 0 && crossing < checked) {
        fprintf(out, crossing > 0 ? ", frame%s" : "; frame%s", touching > 1 ? "s" : "");
        say_frames(out, a, frame_touches);
        fprintf(out, " touch%s (%zu of %zu).", touching > 1 ? "" : "es", touching, checked);
    }
}

/* "3 pairs of triangles cross", as a part of a sentence. */
static void say_pairs(FILE *out, const char *before, size_t count, const char *what, const char *verb) {
    fprintf(out, "%s%zu pair%s of %s %s%s", before, count, count > 1 ? "s" : "", what, verb,
            count > 1                      ? ""
            : strcmp(verb, "overlap") == 0 ? "s"
                                           : "es");
}

static const char *say_crossing(FILE *out, const answers *a, const frame_answer *frame) {
    const uint32_t triangles = cscd_mesh_triangle_count(a->recording->mesh);
    if (frame->crossing == 0) return "";
    say_pairs(out, "", frame->crossing, "triangles", "cross");
    fprintf(out, ", with %u of %u triangles (%.3g %%)", frame->crossing_faces, triangles,
            100.0 * frame->crossing_faces / triangles);
    return "; ";
}

/* Whose interiors meet, although no triangles cross. */
static const char *say_overlaps(FILE *out, const frame_answer *frame, const char *before) {
    if (frame->overlapping > 0) {
        say_pairs(out, before, frame->overlapping, "parts", "overlap");
        before = "; ";
    }
    if (frame->inside > 0) {
        fprintf(out, "%s%zu part%s inside another", before, frame->inside,
                frame->inside > 1 ? "s lie" : " lies");
        before = "; ";
    }
    if (frame->same > 0) {
        fprintf(out, "%s%zu pair%s of parts %s two copies of one solid", before, frame->same,
                frame->same > 1 ? "s" : "", frame->same > 1 ? "are" : "is");
        before = "; ";
    }
    return before;
}

static void say_frame(FILE *out, const answers *a) {
    const frame_answer *frame = answers_frames(a);
    if (!frame_answer_meets(frame) && !frame_answer_crosses(frame)) {
        fprintf(out, frame->duplicates > 0 ? "no two others cross or touch."
                     : frame->depth > 0.0  ? "No two triangles cross or touch, but something lies inside."
                                           : "Clean: no two triangles cross or touch.");
        return;
    }
    const char *before = say_overlaps(out, frame, say_crossing(out, a, frame));
    if (frame->touching > 0 && frame->crossing > 0)
        fprintf(out, "%s%zu touch%s", before, frame->touching, frame->touching > 1 ? "" : "es");
    else if (frame->touching > 0) {
        say_pairs(out, before, frame->touching, "triangles", "touch");
        fprintf(out, ", none cross");
    } else if (frame->crossing == 0)
        fprintf(out, "%sno two triangles cross or touch", before);
    fprintf(out, ".");
}

/* First of all, since a mesh with a triangle too many is not clean, whatever else is found. In a single frame in which nothing
 * is, the sentence goes on. */
static void say_duplicates(FILE *out, const answers *a) {
    const frame_answer *first = answers_frames(a);
    const bool goes_on = is_single(a) && !frame_answer_meets(first) && !frame_answer_crosses(first);
    const char *end = goes_on ? ";" : ".";
    size_t most = 0;
    for (size_t i = 0; i < answers_frame_count(a); i++)
        if (answers_frames(a)[i].duplicates > most) most = answers_frames(a)[i].duplicates;
    if (most == 1) fprintf(out, "One triangle is there twice%s ", end);
    if (most > 1) fprintf(out, "%zu pairs of triangles are the same triangle twice%s ", most, end);
}

static void say_measure(FILE *out, const cscd_event *event, const length_unit *unit) {
    char text[LENGTH_TEXT_SIZE];
    if (event->depth > 0.0)
        fprintf(out, ", %s deep", length_text(event->depth, unit, text));
    else if (event->kinds & CSCD_EVENT_SAME_SOLID)
        fprintf(out, ", one solid twice");
    else if (event->length > 0.0)
        fprintf(out, ", %s along %s", event->kinds & CROSSING ? "crossing" : "touching",
                length_text(event->length, unit, text));
    else if (event->pairs == 0)
        fprintf(out, ", contacts only");
}

/* "A x B, frames 21 to 29, 12.4 mm deep at frame 24". */
static void say_event(FILE *out, const answers *a, const cscd_event *event, const length_unit *unit) {
    const bool single = is_single(a);
    print_pair(out, a, event->a, event->b, 0);
    if (single) {
        say_measure(out, event, unit);
        return;
    }
    fprintf(out, ", frame%s %d", event->last_frame > event->first_frame ? "s" : "",
            answers_frame_number(a, event->first_frame));
    if (event->last_frame > event->first_frame)
        fprintf(out, " to %d", answers_frame_number(a, event->last_frame));
    say_measure(out, event, unit);
    if (event->last_frame > event->first_frame && (event->depth > 0.0 || event->length > 0.0))
        fprintf(out, " at frame %d", answers_frame_number(a, event->worst_frame));
}

void answers_print_worst(FILE *out, const answers *a, const length_unit *unit) {
    say_event(out, a, &a->events[a->worst_first[0]], unit);
}

/* Was not all looked at? Then that is said first. True if there is nothing else to say. */
static bool say_unfinished(FILE *out, const answers *a) {
    const char *reason = answers_unfinished(a);
    if (reason == NULL) return false;
    const size_t checked = count_frames(a, frame_checked), wanted = a->wanted > 0 ? a->wanted : checked;
    const size_t length = strlen(reason);
    fprintf(out, "Not finished: %s%s %zu of %zu frame%s checked", reason,
            length > 0 && reason[length - 1] == '.' ? "" : ".", checked, wanted, wanted == 1 ? "" : "s");
    const bool found = count_frames(a, frame_answer_clean) < checked || a->event_count > 0;
    fprintf(out, checked == 0 || found ? "." : ", clean so far.");
    if (found) fputc(' ', out);
    return !found;
}

/* Less than the recording has, because that was asked for. */
static void say_range(FILE *out, const answers *a) {
    const recording *r = a->recording;
    const size_t count = answers_frame_count(a);
    if (count == 0 || count >= r->frame_count || answers_unfinished(a) != NULL) return;
    const frame_answer *first = &answers_frames(a)[0], *last = &answers_frames(a)[count - 1];
    const uint32_t step = count > 1 ? (last->frame - first->frame) / (uint32_t)(count - 1) : 1;
    fprintf(out, " Only frame%s %d", count > 1 ? "s" : "", answers_frame_number(a, first->frame));
    if (count > 1) fprintf(out, " to %d", answers_frame_number(a, last->frame));
    if (step > 1) fprintf(out, ", in steps of %u,", step);
    fprintf(out, " of %d to %d %s looked at.", r->frame_numbers[0], r->frame_numbers[r->frame_count - 1],
            count > 1 ? "were" : "was");
}

/* What files hold beside it. */
static void say_animations(FILE *out, const answers *a) {
    const recording *r = a->recording;
    for (uint32_t i = 0; i < r->object_count; i++) {
        const recorded_object *object = &r->objects[i];
        const uint32_t count = object->file.animation_count;
        if (recording_object_rests(object))
            fprintf(out, " Only the rest pose of %s was looked at; its file holds %s.", object->source.name,
                    count > 1 ? "animations" : "an animation");
        else if (count > 1 && strcmp(object->source.frame_paths[0], object->source.model_path) == 0)
            fprintf(out, " Only one of the %u animations of %s was played.", count, object->source.name);
    }
}

void answers_print_sentence(FILE *out, const answers *a, const length_unit *unit) {
    const bool single = is_single(a);
    const bool said = say_unfinished(out, a);
    if (!said) say_duplicates(out, a);
    if (!said && single) say_frame(out, a);
    if (!said && !single) say_recording(out, a);
    if (a->event_count > 0) {
        const char *what = single ? "place" : "event";
        fprintf(out, " %zu %s%s, %s", a->event_count, what, a->event_count > 1 ? "s" : "",
                a->event_count > 1 ? "worst: " : "");
        answers_print_worst(out, a, unit);
        fputc('.', out);
    }
    say_range(out, a);
    say_animations(out, a);
    fputc('\n', out);
}

/* ---- tables --------------------------------------------------------------------------------------------- */

/* What an event is, in a word: that which weighs most. */
static const char *event_word(const cscd_event *event) {
    if (event->kinds & CROSSING) return "cross";
    if (event->depth > 0.0) return event->pairs > 0 ? "overlap" : "inside";
    if (event->kinds & CSCD_EVENT_SAME_SOLID) return "copies";
    return event->pairs > 0 ? "touch" : "contact";
}

static void print_length(double length, const length_unit *unit) {
    char text[LENGTH_TEXT_SIZE];
    printf("  %9s", length > 0.0 ? length_text(length, unit, text) : "-");
}

static void print_event(const answers *a, const cscd_event *event, const length_unit *unit, int width) {
    char frames[32];
    print_pair(stdout, a, event->a, event->b, width);
    printf("  %-7s", event_word(event));
    if (!is_single(a)) {
        if (event->last_frame > event->first_frame)
            snprintf(frames, sizeof frames, "%d to %d", answers_frame_number(a, event->first_frame),
                     answers_frame_number(a, event->last_frame));
        else
            snprintf(frames, sizeof frames, "%d", answers_frame_number(a, event->first_frame));
        printf("  %-14s  %6d", frames, answers_frame_number(a, event->worst_frame));
    }
    print_length(event->depth, unit);
    print_length(event->length, unit);
    printf("  %7llu  %8llu\n", (unsigned long long)event->pairs, (unsigned long long)event->contacts);
}

static int widest_pair(const answers *a, size_t shown) {
    int width = text_width("parts");
    for (size_t i = 0; i < shown; i++) {
        const cscd_event *event = &a->events[a->worst_first[i]];
        const int own = pair_width(a, event->a, event->b);
        if (own > width) width = own;
    }
    return width < NAME_WIDTH_MAX ? width : NAME_WIDTH_MAX;
}

void answers_print_events(const answers *a, const length_unit *unit) {
    const size_t shown = a->event_count < EVENTS_SHOWN ? a->event_count : EVENTS_SHOWN;
    if (shown == 0) return;
    const int width = widest_pair(a, shown);
    printf("\n%-*s  %-7s", width, "parts", "what");
    if (!is_single(a)) printf("  %-14s  %6s", "frames", "worst");
    printf("  %9s  %9s  %7s  %8s\n", "depth", "length", "pairs", "contacts");
    for (size_t i = 0; i < shown; i++) print_event(a, &a->events[a->worst_first[i]], unit, width);
    if (shown < a->event_count)
        printf("and %zu more; --events OUT.csv writes all of them\n", a->event_count - shown);
}

static void print_frame(const answers *a, const frame_answer *frame, const length_unit *unit) {
    const double triangles = cscd_mesh_triangle_count(a->recording->mesh);
    printf("%8d  %9zu  %9zu  %8.3f %%", answers_frame_number(a, frame->frame), frame->crossing,
           frame->touching, triangles > 0.0 ? 100.0 * frame->crossing_faces / triangles : 0.0);
    print_length(frame->depth, unit);
    printf("  %10.3f  ", frame->ms);
    print_pair(stdout, a, frame->worst_parts[0], frame->worst_parts[1], 0);
    putchar('\n');
}

/* Duplicates alone make no row. */
static bool frame_has_row(const frame_answer *frame) {
    return frame_answer_meets(frame) || frame_answer_crosses(frame);
}

void answers_print_frames(const answers *a, const length_unit *unit) {
    const size_t checked = count_frames(a, frame_checked), clean = count_frames(a, frame_answer_clean);
    const bool any_row = count_frames(a, frame_has_row) > 0;
    if (any_row)
        printf("\n%8s  %9s  %9s  %10s  %9s  %10s  %s\n", "frame", "crossing", "touching", "share", "depth",
               "ms", "worst");
    double ms = 0.0;
    for (size_t i = 0; i < answers_frame_count(a); i++) {
        const frame_answer *frame = &answers_frames(a)[i];
        ms += frame->ms;
        if (frame_has_row(frame)) print_frame(a, frame, unit);
    }
    if (any_row)
        printf("crossing, touching: pairs of triangles; share: of the triangles that cross another one\n");
    if (checked > 0)
        printf("%zu of %zu frames are clean; a frame took %.3f ms on average\n", clean, checked,
               ms / (double)checked);
}
