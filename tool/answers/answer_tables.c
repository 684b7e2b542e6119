/* The answers for people: a row for each event, and for each frame. */
#include "tool/answers/answer_tables.h"

enum { EVENTS_SHOWN = 20, NAME_WIDTH_MAX = 60 };

/* ---- names ------------------------------------------------------------------------------------------- */

/* Columns that a text takes in a terminal, but for wide characters: characters, not bytes. */
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

/* What an event is, in a word: that which weighs most. */
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
