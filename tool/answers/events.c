/* The order of events, the worst first; and events that only follow from others. */
#include "tool/answers/answers.h"

#include "tool/io/io.h"

#include <stdlib.h>

/* ---- order --------------------------------------------------------------------------------------------- */

/* Is all that the event has that one part lies in itself, within one body, without a pair or a contact? */
static bool event_is_in_itself(const cscd_event *event) {
    return event->a == event->b && event->pairs == 0 && event->contacts == 0 &&
           (event->kinds & CSCD_EVENT_IN_OTHER_BODY) == 0;
}

/* An event within another part comes before one that only touches it, and that before contacts alone. */
static int rank_of(const cscd_event *event) {
    const uint64_t within = cscd_intersection_set(CSCD_INTERSECTION_CROSSING) | CSCD_EVENT_SAME_SOLID;
    if (event_is_in_itself(event)) return 3;
    if ((event->kinds & within) != 0 || event->depth > 0.0) return 0;
    return event->pairs > 0 ? 1 : 2;
}

static int compare_events(const void *left, const void *right) {
    const cscd_event *a = *(const cscd_event *const *)left, *b = *(const cscd_event *const *)right;
    if (rank_of(a) != rank_of(b)) return rank_of(a) - rank_of(b);
    if (a->depth != b->depth) return a->depth > b->depth ? -1 : 1;
    if (a->length != b->length) return a->length > b->length ? -1 : 1;
    if (a->pairs != b->pairs) return a->pairs > b->pairs ? -1 : 1;
    if (a->contacts != b->contacts) return a->contacts > b->contacts ? -1 : 1;
    return (a > b) - (a < b);
}

void event_order_sort(const cscd_event **events, size_t count) {
    qsort(events, count, sizeof *events, compare_events);
}

/* ---- consequences -------------------------------------------------------------------------------------- */

/* Triangles that are one and the same are no event: they never come apart. Nor are points of depth 0
 * alone. */
static bool is_event(const cscd_event *event) {
    const bool has_pairs =
        event->pairs > 0 && event->kinds != cscd_intersection_set(CSCD_INTERSECTION_DUPLICATE);
    return has_pairs || event->contacts > 0 || event->depth > 0.0;
}

/* The frames in which a part has an event with pairs. */
typedef struct part_span {
    uint32_t part;
    uint64_t first, last; /* when sorted: the last of all spans of the part up to this one */
} part_span;

static int compare_spans(const void *left, const void *right) {
    const part_span *a = left, *b = right;
    if (a->part != b->part) return a->part < b->part ? -1 : 1;
    return (a->first > b->first) - (a->first < b->first);
}

static size_t collect_spans(const cscd_event *events, size_t count, part_span *spans) {
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        const cscd_event *e = &events[i];
        if (e->pairs == 0 || !is_event(e)) continue;
        spans[used++] = (part_span){e->a, e->first_frame, e->last_frame};
        if (e->b != e->a) spans[used++] = (part_span){e->b, e->first_frame, e->last_frame};
    }
    qsort(spans, used, sizeof *spans, compare_spans);
    for (size_t i = 1; i < used; i++)
        if (spans[i].part == spans[i - 1].part && spans[i].last < spans[i - 1].last)
            spans[i].last = spans[i - 1].last;
    return used;
}

/* Does a span of the event's part have a frame in common with it? The last span that begins before the event
 * ends knows. */
static bool happens_during(const part_span *spans, size_t count, const cscd_event *event) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const part_span *span = &spans[middle];
        if (span->part < event->a || (span->part == event->a && span->first <= event->last_frame))
            low = middle + 1;
        else
            high = middle;
    }
    return low > 0 && spans[low - 1].part == event->a && spans[low - 1].last >= event->first_frame;
}

bool consequences_leave_out(cscd_event *events, size_t *count) {
    part_span *spans = io_realloc(NULL, (2 * *count + 1) * sizeof *spans);
    if (spans == NULL) return false;
    const size_t span_count = collect_spans(events, *count, spans);
    size_t kept = 0;
    for (size_t i = 0; i < *count; i++) {
        const cscd_event *e = &events[i];
        if (is_event(e) && (!event_is_in_itself(e) || !happens_during(spans, span_count, e)))
            events[kept++] = *e;
    }
    *count = kept;
    free(spans);
    return true;
}
