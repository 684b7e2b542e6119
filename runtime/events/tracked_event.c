/* An event as far as it is known, and how two that turn out to be one become one. */
#include "runtime/events/tracked_event.h"

#include <math.h>

static int compare_numbers(uint64_t a, uint64_t b) {
    return a < b ? -1 : a > b;
}

/* Contacts count where there is nothing else, so that a moment is as bad whether or not the way to it was looked at. */
static bool is_worse(const event_group *a, const event_group *b) {
    const bool contacts_alone = a->depth == 0.0 && a->pairs == 0;
    if (a->depth != b->depth) return a->depth > b->depth;
    if (a->length != b->length) return a->length > b->length;
    if (a->pairs != b->pairs) return a->pairs > b->pairs;
    if (contacts_alone && a->contacts != b->contacts) return a->contacts > b->contacts;
    if (a->index != b->index) return a->index < b->index;
    return a->origin < b->origin;
}

void tracked_event_join(tracked_event *into, const tracked_event *from) {
    if (from->first < into->first || (from->first == into->first && from->origin < into->origin)) {
        into->first = from->first;
        into->first_frame = from->first_frame;
        into->origin = from->origin;
    }
    if (from->last > into->last) {
        into->last = from->last;
        into->last_frame = from->last_frame;
    }
    into->kinds |= from->kinds;
    into->pairs += from->pairs;
    into->depths += from->depths;
    into->contacts += from->contacts;
    into->length = fmax(into->length, from->length);
    if (is_worse(&from->worst, &into->worst)) into->worst = from->worst;
}

int tracked_event_compare(const void *left, const void *right) {
    const tracked_event *a = left, *b = right;
    int order = compare_numbers(a->first, b->first);
    if (order == 0) order = compare_numbers(a->parts, b->parts);
    return order != 0 ? order : compare_numbers(a->origin, b->origin);
}

cscd_event tracked_event_describe(const tracked_event *e) {
    const event_group *worst = &e->worst;
    return (cscd_event){.a = (uint32_t)(e->parts >> 32),
                        .b = (uint32_t)e->parts,
                        .first_frame = e->first_frame,
                        .last_frame = e->last_frame,
                        .worst_frame = worst->frame,
                        .kinds = e->kinds,
                        .pairs = e->pairs,
                        .depths = e->depths,
                        .contacts = e->contacts,
                        .depth = worst->depth,
                        .length = e->length,
                        .x = {worst->x[0], worst->x[1], worst->x[2]},
                        .triangle = (uint32_t)worst->triangle,
                        .first_triangle = e->origin <= UINT32_MAX ? (uint32_t)e->origin : UINT32_MAX};
}
