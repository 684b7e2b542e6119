/* The pairs that one thread of a check finds. */
#include "runtime/intersections/intersection_lane.h"

/* A lane grows by half: with the room that it leaves meanwhile, 27.5 bytes for each pair that it has. */
enum { ROOM_LEAST = 256, EVEN_ROOM_MOST = 1 << 16 };

static bool grow_items(cscd_context *context, intersection_lane *lane, size_t capacity) {
    found_pair *grown = context_grow(context, lane->items, lane->count, capacity, sizeof *lane->items);
    if (grown == NULL) return false;
    lane->items = grown;
    lane->capacity = capacity;
    return true;
}

static bool make_room(cscd_context *context, intersection_lane *lane) {
    return grow_items(context, lane, lane->capacity == 0 ? ROOM_LEAST : lane->capacity + lane->capacity / 2);
}

static bool make_room_for_notes(cscd_context *context, intersection_lane *lane) {
    pair_note *grown = context_grow(context, lane->notes, lane->count, lane->capacity, sizeof *lane->notes);
    if (grown == NULL) return false;
    lane->notes = grown;
    lane->note_capacity = lane->capacity;
    return true;
}

void intersection_lane_add(cscd_context *context, intersection_lane *lane, triangle_pair t) {
    if (lane->count == lane->capacity && !make_room(context, lane))
        lane->out_of_memory = true;
    else
        lane->items[lane->count++] = (found_pair){t.a < t.b ? t.a : t.b, t.a < t.b ? t.b : t.a};
}

void intersection_lane_add_noted(cscd_context *context, intersection_lane *lane, triangle_pair t,
                                 pair_note note) {
    bool room = lane->count < lane->capacity || make_room(context, lane);
    if (room && lane->note_capacity < lane->capacity) room = make_room_for_notes(context, lane);
    if (room) lane->notes[lane->count] = note;
    if (room)
        intersection_lane_add(context, lane, t);
    else
        lane->out_of_memory = true;
}

bool intersection_lanes_even_out(cscd_context *context, intersection_lane *lanes, uint32_t count,
                                 bool notes) {
    size_t total = 0;
    for (uint32_t i = 0; i < count; i++) total += lanes[i].count;
    const size_t room = total <= EVEN_ROOM_MOST ? ROOM_LEAST + total + total / 4 : 0;
    for (uint32_t i = 0; i < count && total > 0; i++) {
        intersection_lane *lane = &lanes[i];
        if (lane->capacity < room && !grow_items(context, lane, room)) return false;
        if (notes && lane->note_capacity < lane->capacity && !make_room_for_notes(context, lane))
            return false;
    }
    return true;
}

void intersection_lane_free(cscd_context *context, intersection_lane *lane) {
    context_free(context, lane->items);
    context_free(context, lane->notes);
}
