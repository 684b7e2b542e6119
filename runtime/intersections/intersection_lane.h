/* The pairs that one thread of a check finds. */
#pragma once

#include "runtime/bvh/traversal.h"
#include "runtime/intersections/vertex_stars.h"

/* Two triangles a < b that intersect, or are duplicates of each other. */
typedef struct found_pair {
    uint32_t a, b;
} found_pair;

/* What is known of a pair, where kinds are asked for: see pair_kind.h. */
typedef struct pair_note {
    uint8_t kind, shared;
    bool
        unlisted; /* a duplicate that the check without kinds does not know, since features that share a vertex do
                    * not intersect */
} pair_note;

/* The findings of one thread. */
typedef struct intersection_lane {
    _Alignas(CACHE_LINE_SIZE) found_pair *items;
    pair_note *notes; /* one for each item where kinds are asked for */
    size_t count, capacity, note_capacity;
    size_t settled; /* so many of the first ones are there to stay: they do not count for the limit */
    star_cursor stars;
    uint32_t zero_area_triangles, first_zero_area; /* UINT32_MAX: none */
    bool out_of_memory;
} intersection_lane;

/* Adds a pair of triangles in any order. No memory: out_of_memory is set. */
void intersection_lane_add(cscd_context *context, intersection_lane *lane, triangle_pair t);
void intersection_lane_add_noted(cscd_context *context, intersection_lane *lane, triangle_pair t,
                                 pair_note note);

/* Which lane finds what depends on when threads come for work, so that a lane might need more room in any call. Once a call
 * has found its pairs, each lane has room for all of them, unless they are very many. False: no memory. */
bool intersection_lanes_even_out(cscd_context *context, intersection_lane *lanes, uint32_t count, bool notes);

/* Frees what the lane holds. */
void intersection_lane_free(cscd_context *context, intersection_lane *lane);

/* Copies a pair of a lane whose notes are kept to another place in it. */
static inline void intersection_lane_move(intersection_lane *lane, size_t from, size_t to) {
    lane->items[to] = lane->items[from];
    lane->notes[to] = lane->notes[from];
}
