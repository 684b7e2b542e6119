/* Marks on the mesh: who has been at a vertex, or at a triangle, with which pair of parts, and when. */
#include "runtime/events/stamp_table.h"

#include <assert.h>
#include <string.h>

static array_list list_arrays(stamp_table *t) {
    return (array_list){{ARRAY(t->stamps, t->capacity), ARRAY(t->places, (size_t)t->place_mask + 1)}};
}

/* The multiplier of Fibonacci hashing, twice: the upper bits depend on all of parts and element. */
static uint32_t hash_of(uint64_t parts, uint32_t element) {
    const uint64_t golden = 0x9e3779b97f4a7c15u;
    uint64_t mixed = (parts * golden ^ element) * golden;
    return (uint32_t)(mixed >> 32);
}

static void place_stamp(stamp_table *t, size_t number) {
    const stamp *s = &t->stamps[number];
    uint32_t place = hash_of(s->parts, s->element) & t->place_mask;
    while (t->places[place] != 0) place = (place + 1) & t->place_mask;
    t->places[place] = (uint32_t)number + 1;
}

static void place_all(stamp_table *t) {
    for (size_t i = 0; i < t->count; i++) place_stamp(t, i);
}

bool stamp_table_reserve(cscd_context *context, stamp_table *t, size_t more) {
    if (more <= t->capacity - t->count) return true;
    stamp_table grown = {.count = t->count};
    const size_t needed = t->count + more, wanted = 2 * needed + 16;
    if (needed > UINT32_MAX / 4 - 8) return false;
    uint64_t places = 64; /* up to 2^32 */
    while (places < 2 * (uint64_t)wanted) places *= 2;
    grown.capacity = wanted;
    grown.place_mask = (uint32_t)(places - 1);
    if (!context_allocate_all(context, list_arrays(&grown))) return false;
    if (t->count > 0) memcpy(grown.stamps, t->stamps, t->count * sizeof *t->stamps);
    place_all(&grown);
    stamp_table_free(context, t);
    *t = grown;
    return true;
}

void stamp_table_free(cscd_context *context, stamp_table *t) {
    context_free(context, t->stamps);
    context_free(context, t->places);
    *t = (stamp_table){.stamps = NULL};
}

stamp *stamp_table_find(const stamp_table *t, uint64_t parts, uint32_t element) {
    if (t->count == 0) return NULL;
    uint32_t place = hash_of(parts, element) & t->place_mask;
    for (; t->places[place] != 0; place = (place + 1) & t->place_mask) {
        stamp *s = &t->stamps[t->places[place] - 1];
        if (s->element == element && s->parts == parts) return s;
    }
    return NULL;
}

void stamp_table_add(stamp_table *t, stamp added) {
    assert(t->count < t->capacity);
    t->stamps[t->count] = added;
    place_stamp(t, t->count++);
}

void stamp_table_clear(stamp_table *t) {
    stamp_table_shrink(t, 0);
}

void stamp_table_shrink(stamp_table *t, size_t count) {
    if (t->count == 0) return;
    t->count = count;
    memset(t->places, 0, ((size_t)t->place_mask + 1) * sizeof *t->places);
    place_all(t);
}
