/* An event as far as it is known, and how two that turn out to be one become one. */
#pragma once

#include <cscd/events.h>

/* The worst group of an event: what is joined in one frame. */
typedef struct event_group {
    double depth, length;
    uint64_t pairs, contacts;
    uint64_t index;  /* of the frame, counted from the first one */
    uint64_t frame;  /* its number */
    uint64_t origin; /* see below; tells groups of one frame and pair of parts apart */
    uint64_t triangle;
    double x[3];
} event_group;

/* All members can be joined in any order: none needs to know which parts of an event were joined first. */
typedef struct tracked_event {
    uint64_t parts;       /* the key of a pair of parts */
    uint64_t first, last; /* frames, counted from the first one */
    uint64_t first_frame, last_frame;
    uint64_t origin; /* the least triangle of the first frame; 2^32 + the least vertex if there is none */
    uint64_t kinds, pairs, depths, contacts;
    double length;
    event_group worst;
} tracked_event;

/* The origin of a vertex that no triangle has. */
static inline uint64_t origin_of_loose(uint32_t vertex) {
    return UINT64_C(1) << 32 | vertex;
}

/* The two are one event: the first becomes it. */
void tracked_event_join(tracked_event *into, const tracked_event *from);

/* The order of events: for sorting, as qsort wants it. No two events are equal. */
int tracked_event_compare(const void *left, const void *right);

cscd_event tracked_event_describe(const tracked_event *event);
