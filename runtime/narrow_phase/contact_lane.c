/* The contacts that one thread finds in an interval, and the pairs of features that it still has to test. */
#include "runtime/narrow_phase/contact_lane.h"

#include <string.h>

void contact_lane_reset(contact_lane *lane) {
    lane->count = lane->settled = 0;
    lane->limit = SIZE_MAX;
    lane->suspended = false;
    lane->cursor = 0;
    lane->feature_pairs = 0;
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) lane->decided[i] = 0;
    lane->separations = 0;
    lane->out_of_memory = false;
    for (int kind = 0; kind < 2; kind++) lane->queue[kind].count = 0;
    for (int kind = 0; kind < 2; kind++) lane->candidates[kind].count = 0;
}

bool contact_lane_reserve(cscd_context *context, contact_lane *lane, size_t count) {
    while (contact_lane_capacity(lane) < count) {
        const size_t before = contact_lane_capacity(lane), room = before == 0 ? LANE_FIRST_BLOCK : before;
        cscd_contact *block = context_reserve(context, room, sizeof *block);
        if (block == NULL) return false;
        lane->blocks[lane->block_count++] = block;
    }
    return true;
}

void contact_lane_free(cscd_context *context, contact_lane *lane) {
    while (lane->block_count > 0) context_free(context, lane->blocks[--lane->block_count]);
    lane->count = lane->settled = 0;
}

void contact_lane_add(cscd_context *context, contact_lane *lane, cscd_contact_kind kind, uint32_t a,
                      uint32_t b, const elementary_contact *where, bool bounded) {
    if (!contact_lane_reserve(context, lane, lane->count + 1)) {
        lane->out_of_memory = true;
        return;
    }
    cscd_contact *contact = contact_lane_at(lane, lane->count++);
    memset(contact, 0, sizeof *contact); /* padding too: lists are compared bit for bit */
    contact->kind = kind;
    contact->a = a;
    contact->b = b;
    contact->toi = where->toi;
    contact->u = where->u;
    contact->v = where->v;
    memcpy(contact->point, where->point, sizeof contact->point);
    memcpy(contact->normal, where->normal, sizeof contact->normal);
    contact->bounded = bounded;
}

static bool make_candidate_room(cscd_context *context, contact_lane *lane, candidate_list *list,
                                size_t count) {
    if (list->count + count <= list->capacity) return true;
    size_t capacity = 2 * list->capacity + FEATURE_LIST_CAPACITY;
    uint32_t(*grown)[2] = context_grow(context, list->pairs, list->count, capacity, sizeof *list->pairs);
    if (grown == NULL) {
        lane->out_of_memory = true;
        return false;
    }
    list->pairs = grown;
    list->capacity = capacity;
    return true;
}

void contact_lane_add_candidates(cscd_context *context, contact_lane *lane, cscd_contact_kind kind,
                                 const feature_list *pairs) {
    candidate_list *list = &lane->candidates[kind];
    if (!make_candidate_room(context, lane, list, pairs->count)) return;
    for (uint32_t i = 0; i < pairs->count; i++) {
        list->pairs[list->count][0] = pairs->a[i];
        list->pairs[list->count++][1] = pairs->b[i];
    }
}
