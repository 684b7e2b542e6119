/* The answers for people: a sentence, which comes first, and tables of events and frames. */
#include "tool/answers/answers.h"

#include <string.h>

enum { SPANS_SAID = 6 };

static bool frame_touches(const frame_answer *frame) {
    return !frame_answer_crosses(frame) && frame->touching > 0;
}

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

/* ---- the sentence --------------------------------------------------------------------------------------- */

/* The kinds of frames, the weightiest first: each frame counts for one of these. */
static bool triangles_cross(const frame_answer *frame) {
    return frame->crossing > 0;
}

static bool parts_overlap(const frame_answer *frame) {
    return frame->crossing == 0 && frame->overlapping > 0;
}

static bool parts_lie_inside(const frame_answer *frame) {
    return frame->crossing + frame->overlapping == 0 && frame->inside > 0;
}

static bool parts_are_copies(const frame_answer *frame) {
    return frame->crossing + frame->overlapping + frame->inside == 0 && frame->same > 0;
}

/* " cross, overlap or have one part inside another": what there is in frames that count as crossing. */
static void say_what_frames_do(FILE *out, const answers *a, bool one) {
    static const struct {
        frame_test *test;
        const char *of_several, *of_one;
    } verbs[] = {{triangles_cross, "cross", "crosses"},
                 {parts_overlap, "overlap", "overlaps"},
                 {parts_lie_inside, "have one part inside another", "has one part inside another"},
                 {parts_are_copies, "have two copies of one solid", "has two copies of one solid"}};
    size_t left = 0, said = 0;
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) left += answers_count(a, verbs[i].test) > 0;
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) {
        if (answers_count(a, verbs[i].test) == 0) continue;
        left--;
        fprintf(out, "%s%s",
                said++ == 0 ? " "
                : left > 0  ? ", "
                            : " or ",
                one ? verbs[i].of_one : verbs[i].of_several);
    }
}

static void say_recording(FILE *out, const answers *a) {
    const size_t checked = answers_count(a, frame_answer_checked);
    const size_t crossing = answers_count(a, frame_answer_crosses),
                 touching = answers_count(a, frame_touches);
    if (checked == 0)
        fprintf(out, answers_count(a, frame_answer_without_area) > 0 ? "No triangle has an area in any frame."
                                                                     : "No frame was checked.");
    else if (crossing == checked && checked > 1) {
        fprintf(out, "All %zu frames", checked);
        say_what_frames_do(out, a, false);
        fprintf(out, ".");
    } else if (crossing > 0) {
        fprintf(out, "Frame%s", crossing > 1 ? "s" : "");
        say_frames(out, a, frame_answer_crosses);
        say_what_frames_do(out, a, crossing == 1);
        fprintf(out, " (%zu of %zu)", crossing, checked);
        if (touching == 0) fprintf(out, ".");
    } else
        fprintf(out, touching > 0 ? "No frame crosses" : "No frame crosses or touches (%zu checked).",
                checked);
    if (touching > 0 && crossing < checked) {
        fprintf(out, crossing > 0 ? ", frame%s" : "; frame%s", touching > 1 ? "s" : "");
        say_frames(out, a, frame_touches);
        fprintf(out, " touch%s (%zu of %zu).", touching > 1 ? "" : "es", touching, checked);
    }
    const size_t without = answers_count(a, frame_answer_without_area);
    if (without == 0 || checked == 0) return;
    fprintf(out, " No triangle has an area in frame%s", without > 1 ? "s" : "");
    say_frames(out, a, frame_answer_without_area);
    fprintf(out, ", which %s not looked at.", without > 1 ? "were" : "was");
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
    if (!frame->unlisted)
        fprintf(out, ", with %u of %u triangles (%.3g %%)", frame->crossing_faces, triangles,
                100.0 * frame->crossing_faces / triangles);
    return "; ";
}

/* Parts whose interiors meet, although no triangles cross. */
static const char *say_overlaps(FILE *out, const frame_answer *frame, const char *before) {
    if (frame->overlapping > 0) {
        say_pairs(out, before, frame->overlapping, "parts", "overlap");
        before = "; ";
    }
    if (frame->inside > 0) {
        fprintf(out, "%s%zu part%s", before, frame->inside,
                frame->inside > 1 ? "s lie inside others" : " lies inside another");
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
    if (frame->without_area) {
        fprintf(out, "No triangle has an area.");
        return;
    }
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

/* First of all, since a mesh with a triangle too many is not clean, whatever else is found. In a single frame
 * in which nothing is, the sentence goes on. */
static void say_duplicates(FILE *out, const answers *a) {
    const frame_answer *first = answers_frames(a);
    const bool goes_on = answers_single(a) && !frame_answer_meets(first) && !frame_answer_crosses(first);
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
        fprintf(out, ", %s along %s",
                event->kinds & cscd_intersection_set(CSCD_INTERSECTION_CROSSING) ? "crossing" : "touching",
                length_text(event->length, unit, text));
    else if (event->pairs == 0)
        fprintf(out, ", contacts only");
}

/* "A x B, frames 21 to 29, 12.4 mm deep at frame 24". */
static void say_event(FILE *out, const answers *a, const cscd_event *event, const length_unit *unit) {
    const bool single = answers_single(a);
    fprintf(out, "%s x %s", part_names_at(a->parts, event->a), answers_second_name(a, event->a, event->b));
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

/* Was not all looked at? Then that is said first. True if there is nothing else to say. */
static bool say_unfinished(FILE *out, const answers *a) {
    const char *reason = answers_unfinished(a);
    if (reason == NULL) return false;
    const size_t checked = answers_count(a, frame_answer_checked),
                 wanted = a->wanted > 0 ? a->wanted : checked;
    const size_t length = strlen(reason);
    fprintf(out, "Not finished: %s%s %zu of %zu frame%s checked", reason,
            length > 0 && strchr(".?", reason[length - 1]) != NULL ? "" : ".", checked, wanted,
            wanted == 1 ? "" : "s");
    const bool found = answers_count(a, frame_answer_clean) < checked || a->event_count > 0;
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

static void say_left_out_pairs(FILE *out, size_t count, size_t all, const char *of, size_t *said, bool last) {
    if (count == 0) return;
    fputs(*said == 0 ? " As asked, " : last ? " and " : ", ", out);
    fprintf(out, "%zu", count);
    if (all > 0) fprintf(out, " of %zu", all);
    fprintf(out, " pair%s of %s", (all > 0 ? all : count) > 1 ? "s" : "", of);
    *said += count;
}

void ignored_pairs_say(FILE *out, const ignore_pairs *ignored) {
    if (!ignore_pairs_any(ignored)) return;
    const ignore_counts counts = ignore_pairs_count(ignored);
    size_t said = 0;
    say_left_out_pairs(out, counts.parts, counts.all_parts, "parts", &said,
                       counts.components + counts.triangles == 0);
    say_left_out_pairs(out, counts.components, 0, "components", &said, counts.triangles == 0);
    say_left_out_pairs(out, counts.triangles, 0, "triangles", &said, true);
    if (said > 0) fprintf(out, " %s not looked at.", said > 1 ? "were" : "was");
}

/* Says which animations the files hold that are not played. */
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

/* ---- what has no surface ---------------------------------------------------------------------------------- */

enum { COLLAPSED_SAID = 5 };

/* " in frames 2 to 3, 5"; nothing for a single mesh. */
static void say_places(FILE *out, const answers *a, const frame_list *list) {
    const frame_answer *frames = answers_frames(a);
    if (answers_single(a)) return;
    fprintf(out, " in frame%s", frame_list_frames(list) > 1 ? "s" : "");
    for (uint32_t i = 0; i < list->count && i < SPANS_SAID; i++) {
        const frame_span *span = &list->spans[i];
        fprintf(out, "%s%d", i > 0 ? ", " : " ", answers_frame_number(a, frames[span->first].frame));
        if (span->last > span->first)
            fprintf(out, " to %d", answers_frame_number(a, frames[span->last].frame));
    }
    if (list->count > SPANS_SAID) fprintf(out, " and others");
}

/* Has the part no surface in frames in which others have one? Of the rest it is said that no triangle has an
 * area. */
static bool is_missing(const answers *a, const collapsed_part *frames) {
    return frame_list_frames(&frames->whole) > answers_count(a, frame_answer_without_area);
}

/* "Smoke has no surface in frames 2 to 3 (all its triangles have no area), and was not looked at there." */
static void say_collapsed(FILE *out, const answers *a, uint32_t part, const collapsed_part *frames) {
    const char *there = answers_single(a) ? "" : " there";
    if (is_missing(a, frames)) {
        fprintf(out, " %s has no surface", part_names_at(a->parts, part));
        say_places(out, a, &frames->whole);
        fprintf(out, " (all its triangles have no area), and was not looked at%s.", there);
    }
    if (frames->partly.count > 0) {
        fprintf(out, " Some pieces of %s have no surface", part_names_at(a->parts, part));
        say_places(out, a, &frames->partly);
        fprintf(out, " (all their triangles have no area), and were not looked at%s.", there);
    }
}

static void say_what_has_collapsed(FILE *out, const answers *a) {
    uint32_t said = 0;
    for (uint32_t i = 0; i < a->parts->count; i++) {
        const collapsed_part *frames = collapsed_parts_at(&a->collapsed, i);
        if (frames == NULL || (!is_missing(a, frames) && frames->partly.count == 0)) continue;
        if (++said <= COLLAPSED_SAID) say_collapsed(out, a, i, frames);
    }
    if (said > COLLAPSED_SAID)
        fprintf(out, " So it is with %u other part%s.", said - COLLAPSED_SAID,
                said > COLLAPSED_SAID + 1 ? "s" : "");
}

/* Without depths nobody knows whether parts share space whose triangles do not cross. */
static void say_what_is_not_known(FILE *out, const answers *a) {
    if (a->depths || answers_count(a, frame_answer_checked) == 0) return;
    if (answers_count(a, frame_answer_crosses) == 0) fputs(" What lies inside was not looked at.", out);
}

void answers_print_sentence(FILE *out, const answers *a, const length_unit *unit) {
    const bool single = answers_single(a);
    const bool said = say_unfinished(out, a);
    if (!said) say_duplicates(out, a);
    if (!said && single) say_frame(out, a);
    if (!said && !single) say_recording(out, a);
    if (a->event_count > 0) {
        const char *what = single ? "place" : "event";
        fprintf(out, " %zu %s%s, %s", a->event_count, what, a->event_count > 1 ? "s" : "",
                a->event_count > 1 ? "worst: " : "");
        say_event(out, a, &a->events[a->worst_first[0]], unit);
        fputc('.', out);
    }
    say_what_is_not_known(out, a);
    ignored_pairs_say(out, a->shown.ignored);
    say_range(out, a);
    say_animations(out, a);
    say_what_has_collapsed(out, a);
    fputc('\n', out);
}

/* ---- the answers for people: a row for each event, and for each frame ------------------------------------ */

enum { EVENTS_SHOWN = 20, NAME_WIDTH_MAX = 60 };

/* ---- names ------------------------------------------------------------------------------------------- */

/* Columns that a text takes in a terminal, wide characters aside: characters, not bytes. */
static int text_width(const char *text) {
    int width = 0;
    for (; *text != '\0'; text++) width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

static int pair_width(const answers *a, uint32_t first, uint32_t second) {
    return text_width(part_names_at(a->parts, first)) + 3 + text_width(answers_second_name(a, first, second));
}

/* Filled with blanks. */
static void print_pair(const answers *a, uint32_t first, uint32_t second, int width) {
    printf("%s x %s", part_names_at(a->parts, first), answers_second_name(a, first, second));
    printf("%*s", width > pair_width(a, first, second) ? width - pair_width(a, first, second) : 0, "");
}

/* ---- events --------------------------------------------------------------------------------------------- */

/* The kind of an event in a word: that which weighs most. */
static const char *event_word(const cscd_event *event) {
    if (event->kinds & cscd_intersection_set(CSCD_INTERSECTION_CROSSING)) return "cross";
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
    print_pair(a, event->a, event->b, width);
    printf("  %-7s", event_word(event));
    if (!answers_single(a)) {
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
    if (!answers_single(a)) printf("  %-14s  %6s", "frames", "worst");
    printf("  %9s  %9s  %7s  %8s\n", "depth", "length", "pairs", "contacts");
    for (size_t i = 0; i < shown; i++) print_event(a, &a->events[a->worst_first[i]], unit, width);
    if (shown < a->event_count)
        printf("and %zu more; --events OUT.csv writes all of them\n", a->event_count - shown);
}

/* ---- frames --------------------------------------------------------------------------------------------- */

static void print_frame(const answers *a, const frame_answer *frame, const length_unit *unit) {
    const double triangles = cscd_mesh_triangle_count(a->recording->mesh);
    printf("%8d  %9zu  %9zu", answers_frame_number(a, frame->frame), frame->crossing, frame->touching);
    if (frame->unlisted)
        printf("  %10s", "-");
    else
        printf("  %8.3f %%", triangles > 0.0 ? 100.0 * frame->crossing_faces / triangles : 0.0);
    print_length(frame->depth, unit);
    printf("  %10.3f  ", frame->ms);
    if (frame->worst_parts[0] == NO_PART)
        putchar('-');
    else
        print_pair(a, frame->worst_parts[0], frame->worst_parts[1], 0);
    putchar('\n');
}

/* Duplicates alone make no row. */
static bool frame_has_row(const frame_answer *frame) {
    return frame_answer_meets(frame) || frame_answer_crosses(frame);
}

void answers_print_frames(const answers *a, const length_unit *unit) {
    const size_t checked = answers_count(a, frame_answer_checked),
                 clean = answers_count(a, frame_answer_clean);
    const bool any_row = answers_count(a, frame_has_row) > 0;
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
