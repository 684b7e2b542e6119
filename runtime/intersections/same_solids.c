/* Which bodies are two copies of one solid. */
#include "runtime/intersections/same_solids.h"

#include "src/core/sort.h"

#include <math.h>

void same_solids_free(same_solids *s) {
    if (s->context == NULL) return;
    context_free(s->context, s->pairs);
    context_free(s->context, s->spare);
    *s = (same_solids){.context = s->context};
}

static uint64_t key_of(uint32_t a, uint32_t b) {
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static size_t find_key(const same_solids *s, uint64_t key) {
    size_t low = 0, high = s->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (s->pairs[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool same_solids_have(const same_solids *s, uint32_t a, uint32_t b) {
    const size_t at = find_key(s, key_of(a, b));
    return at < s->count && s->pairs[at] == key_of(a, b);
}

/* Bodies that share area. */
static bool list_candidates(same_solids *s, const named_surface *surface, memory_budget *budget,
                            const cscd_intersection_pair *pairs, size_t count) {
    size_t coplanar = 0, kept = 0;
    s->count = 0;
    for (size_t i = 0; i < count; i++) coplanar += pairs[i].kind == CSCD_INTERSECTION_COPLANAR;
    if (coplanar == 0) return true;
    const size_t room = room_with_spare(coplanar);
    const array_list list = {{ARRAY(s->pairs, room), ARRAY(s->spare, room)}};
    if (!memory_budget_take_all(budget, list)) return false;
    if (!context_renew_all(s->context, list, &s->capacity, coplanar)) return false;
    for (size_t i = 0; i < count; i++) {
        if (pairs[i].kind != CSCD_INTERSECTION_COPLANAR) continue;
        const uint32_t a = surface_body(surface, pairs[i].a), b = surface_body(surface, pairs[i].b);
        if (a != b) s->pairs[s->count++] = key_of(a, b);
    }
    sort_by_number(s->pairs, s->spare, s->count, sizeof *s->pairs);
    for (size_t i = 0; i < s->count; i++)
        if (i == 0 || s->pairs[i] != s->pairs[i - 1]) s->pairs[kept++] = s->pairs[i];
    s->count = kept;
    return true;
}

/* Marks those of which something is within the other, and leaves them out. */
static void leave_out_deep(same_solids *s, const named_surface *surface, const cscd_depths *depths) {
    size_t kept = 0;
    for (size_t i = 0; i < s->count; i++) s->spare[i] = 0;
    for (size_t i = 0; i < depths->count; i++) {
        const cscd_depth *at = &depths->items[i];
        const uint64_t key = key_of(surface_body(surface, at->face), at->body);
        const size_t place = at->depth > 0.0 ? find_key(s, key) : s->count;
        if (place < s->count && s->pairs[place] == key) s->spare[place] = 1;
    }
    for (size_t i = 0; i < s->count; i++)
        if (s->spare[i] == 0) s->pairs[kept++] = s->pairs[i];
    s->count = kept;
}

/* What bodies share that only lie beside each other is a volume by rounding. */
static bool shares_volume(const cscd_overlap *o) {
    return o->volume > 0x1p-40 * pow(o->area_a + o->area_b, 1.5);
}

cscd_status same_solids_find(same_solids *s, const surface_cuts *found, const cscd_intersection_pair *pairs,
                             size_t pair_count, const cscd_depths *depths, overlap_finder *overlaps,
                             const left_out_pairs *left_out) {
    cscd_overlaps shared;
    size_t kept = 0;
    s->bodies = found->surface->bodies;
    if (!list_candidates(s, found->surface, found->budget, pairs, pair_count)) return CSCD_OUT_OF_MEMORY;
    leave_out_deep(s, found->surface, depths);
    if (s->count == 0) return CSCD_OK;
    cscd_status status = overlap_finder_run(overlaps, found, left_out, &shared);
    if (status != CSCD_OK) return status;
    for (size_t i = 0; i < shared.count; i++) {
        const cscd_overlap *o = &shared.items[i];
        if (o->a != o->b && same_solids_have(s, o->a, o->b) && shares_volume(o))
            s->spare[kept++] = key_of(o->a, o->b);
    }
    for (size_t i = 0; i < kept; i++) s->pairs[i] = s->spare[i];
    s->count = kept;
    return CSCD_OK;
}
