/* The order of events, the worst first. */
#include "tool/common/event_order.h"

#include <stdlib.h>

bool event_is_in_itself(const cscd_event *event) {
    return event->a == event->b && event->pairs == 0 && event->contacts == 0 &&
           (event->kinds & CSCD_EVENT_IN_OTHER_BODY) == 0;
}

/* What is within another part comes before what only touches it, and that before contacts alone. */
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
