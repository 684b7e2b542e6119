/* The events of all frames so far, and how those of the next frame join them. */
#include "runtime/events/events.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* ---- events, and how two that turn out to be one become one ------------------------------------------------ */

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

/* ---- memory --------------------------------------------------------------------------------------------- */

static bool reserve_events(cscd_context *context, event_history *h, size_t more) {
    if (more <= h->event_capacity - h->event_count) return true;
    size_t capacity = room_with_spare(h->event_count + more);
    if (capacity >= NO_EVENT) return false;
    tracked_event *events = context_reserve(context, capacity, sizeof *events);
    uint32_t *parents = context_reserve(context, capacity, sizeof *parents);
    if (events == NULL || parents == NULL) {
        context_free(context, events);
        context_free(context, parents);
        return false;
    }
    if (h->event_count > 0) {
        memcpy(events, h->events, h->event_count * sizeof *events);
        memcpy(parents, h->parents, h->event_count * sizeof *parents);
    }
    context_free(context, h->events);
    context_free(context, h->parents);
    h->events = events;
    h->parents = parents;
    h->event_capacity = capacity;
    return true;
}

bool event_history_reserve(cscd_context *context, event_history *h, size_t events, size_t closed) {
    if (!reserve_events(context, h, events)) return false;
    if (closed <= h->closed_capacity - h->closed_count) return true;
    size_t capacity = room_with_spare(h->closed_count + closed);
    tracked_event *grown = context_grow(context, h->closed, h->closed_count, capacity, sizeof *grown);
    if (grown == NULL) return false;
    h->closed = grown;
    h->closed_capacity = capacity;
    return true;
}

void event_history_clear(event_history *h) {
    h->frame_count = h->last_frame = 0;
    h->event_count = h->open_count = h->closed_count = 0;
    stamp_table_clear(&h->last);
}

void event_history_free(cscd_context *context, event_history *h) {
    context_free(context, h->events);
    context_free(context, h->parents);
    context_free(context, h->closed);
    stamp_table_free(context, &h->last);
    *h = (event_history){.gap = h->gap};
}

/* ---- events that are no longer needed ------------------------------------------------------------------- */

/* The event that has all of this one. It shortens the paths that it follows, so many calls take little time. */
static uint32_t event_root(event_history *h, uint32_t event) {
    uint32_t *parents = h->parents;
    while (parents[event] != event) {
        parents[event] = parents[parents[event]];
        event = parents[event];
    }
    return event;
}

/* Whether a frame, counted from the first one, may be joined to the next frame. */
static bool frame_is_last(const event_history *h, uint64_t frame) {
    return frame + h->gap + 1 >= h->frame_count;
}

/* Takes stamps out that are too old, and makes the events that have it all their owners. */
static void renew_stamps(event_history *h) {
    stamp *kept = h->last.stamps;
    for (size_t i = 0; i < h->last.count; i++) {
        stamp s = h->last.stamps[i];
        if (!frame_is_last(h, s.frame)) continue;
        s.owner = event_root(h, s.owner);
        *kept++ = s;
    }
    if (h->last.count > 0) stamp_table_shrink(&h->last, (size_t)(kept - h->last.stamps));
}

/* Moves the events that are their own parents together, in their order; parents say where to, meanwhile. */
static void compact_events(event_history *h) {
    renew_stamps(h);
    uint32_t count = 0;
    for (uint32_t e = 0; e < h->event_count; e++) {
        if (h->parents[e] != e) continue;
        h->events[count] = h->events[e];
        h->parents[e] = count++;
    }
    for (size_t i = 0; i < h->last.count; i++) h->last.stamps[i].owner = h->parents[h->last.stamps[i].owner];
    for (uint32_t e = 0; e < count; e++) h->parents[e] = e;
    h->event_count = count;
}

static void close_event(event_history *h, uint32_t event) {
    assert(h->closed_count < h->closed_capacity);
    h->closed[h->closed_count++] = h->events[event];
    h->parents[event] = NO_EVENT;
    h->open_count--;
}

void event_history_close(event_history *h) {
    for (uint32_t e = 0; e < h->event_count; e++) {
        if (h->parents[e] == e) close_event(h, e);
    }
}

static void close_old_events(event_history *h) {
    for (uint32_t e = 0; e < h->event_count; e++) {
        if (h->parents[e] == e && !frame_is_last(h, h->events[e].last)) close_event(h, e);
    }
}

/* ---- the next frame ------------------------------------------------------------------------------------- */

static void add_events(event_history *h, const frame_row *next) {
    for (size_t i = 0; i < next->event_count; i++) {
        tracked_event *event = &h->events[h->event_count];
        *event = next->events[i];
        event->first += h->frame_count;
        event->last += h->frame_count;
        event->worst.index += h->frame_count;
        h->parents[h->event_count] = (uint32_t)h->event_count;
        h->event_count++;
    }
    h->open_count += next->event_count;
}

/* The events of both stamps are one if the frames are near enough to each other. */
static void join_stamps(event_history *h, const stamp *before, const stamp *after) {
    if (before == NULL || after->frame - before->frame > (uint64_t)h->gap + 1) return;
    uint32_t a = event_root(h, before->owner), b = event_root(h, after->owner);
    if (a == b) return;
    tracked_event_join(&h->events[a], &h->events[b]);
    h->parents[b] = a;
    h->open_count--;
}

/* A stamp of the next frame, as the history counts; `events` were there before it. */
static stamp moved_stamp(const event_history *h, const stamp *s, size_t events) {
    return (stamp){s->parts, s->frame + h->frame_count, s->element, s->owner + (uint32_t)events};
}

static void join_frame(event_history *h, const mesh_rings *rings, const stamp_table *stamps, size_t events) {
    for (size_t i = 0; i < stamps->count; i++) {
        const stamp s = moved_stamp(h, &stamps->stamps[i], events);
        join_stamps(h, stamp_table_find(&h->last, s.parts, s.element), &s);
        for (size_t n = rings->odd ? rings->offsets[s.element] : 0;
             rings->odd && n < rings->offsets[s.element + 1]; n++)
            join_stamps(h, stamp_table_find(&h->last, s.parts, rings->neighbours[n]), &s);
    }
}

static void add_stamps(event_history *h, const stamp_table *stamps, size_t events) {
    for (size_t i = 0; i < stamps->count; i++) {
        const stamp moved = moved_stamp(h, &stamps->stamps[i], events);
        stamp *known = stamp_table_find(&h->last, moved.parts, moved.element);
        if (known != NULL)
            *known = moved;
        else
            stamp_table_add(&h->last, moved);
    }
}

static bool make_room(cscd_context *context, event_history *h, const frame_row *next) {
    if (h->event_count > 2 * h->open_count + h->last.count / 16 + 16 ||
        next->stamps.count > h->last.capacity - h->last.count)
        compact_events(h);
    return event_history_reserve(context, h, next->event_count, h->event_count + next->event_count) &&
           stamp_table_reserve(context, &h->last, next->stamps.count);
}

cscd_status event_history_append(cscd_context *context, event_history *h, const mesh_rings *rings,
                                 const frame_row *next) {
    if (!make_room(context, h, next)) return CSCD_OUT_OF_MEMORY;
    const size_t events = h->event_count;
    add_events(h, next);
    join_frame(h, rings, &next->stamps, events);
    add_stamps(h, &next->stamps, events);
    h->last_frame = next->frame;
    h->frame_count++;
    close_old_events(h);
    return CSCD_OK;
}
