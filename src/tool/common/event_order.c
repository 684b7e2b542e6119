/* The order of events, the worst first. */
#include "src/tool/common/event_order.h"

#include <stdbool.h>
#include <stdlib.h>

static bool only_in_itself(const cscd_event *event) {
    return event->a == event->b && event->pairs == 0 && event->contacts == 0;
}

static int compare_events(const void *left, const void *right) {
    const cscd_event *a = *(const cscd_event *const *)left, *b = *(const cscd_event *const *)right;
    if (only_in_itself(a) != only_in_itself(b)) return only_in_itself(a) ? 1 : -1;
    if (a->depth != b->depth) return a->depth > b->depth ? -1 : 1;
    if (a->length != b->length) return a->length > b->length ? -1 : 1;
    if (a->pairs != b->pairs) return a->pairs > b->pairs ? -1 : 1;
    if (a->contacts != b->contacts) return a->contacts > b->contacts ? -1 : 1;
    return (a > b) - (a < b);
}

void event_order_sort(const cscd_event **events, size_t count) {
    qsort(events, count, sizeof *events, compare_events);
}
