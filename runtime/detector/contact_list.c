/* The interval's contacts from all threads as one sorted list. */
#include "runtime/detector/contact_list.h"

#include "src/core/sort.h"

#include <string.h>

/* Every lane has room for so many contacts, or for all, and for twice its share of more. */
enum { CONTACTS_FOR_ALL = 4096 };

/* What one thread copies at a time. */
enum { CONTACTS_PER_COPY = 4096 };

bool contact_list_leaves_out(const cscd_detector *d, const cscd_contact *contact) {
    const exclusions *e = &d->exclusions;
    return exclusions_any(e) && exclusions_cover_features(e, contact->kind, contact->a, contact->b);
}

/* A contact, and its time as a number. */
typedef struct sort_key {
    uint64_t key;
    const cscd_contact *of;
} sort_key;

/* Of contacts at the same time. */
static int compare_names(const void *left, const void *right) {
    const cscd_contact *l = ((const sort_key *)left)->of, *r = ((const sort_key *)right)->of;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

/* Numbers from 0 on are in the order of their bits. */
static uint64_t bits_of(double toi) {
    uint64_t bits;
    double positive = toi + 0.0; /* not -0 */
    memcpy(&bits, &positive, sizeof bits);
    return bits;
}

/* By (toi, kind, a, b). */
static void sort_contacts(sort_key *keys, sort_key *scratch, size_t count) {
    sort_by_number(keys, scratch, count, sizeof *keys);
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && keys[end].key == keys[begin].key;) end++;
        if (end - begin > 1) sort_items(keys + begin, scratch, end - begin, sizeof *keys, compare_names);
    }
}

static void add_counters(const contact_lane *lane, cscd_counters *counters) {
    counters->feature_pairs += lane->feature_pairs;
    counters->by_signs += lane->decided[ELEMENTARY_SIGNS];
    counters->by_roots += lane->decided[ELEMENTARY_ROOTS];
    counters->by_exact += lane->decided[ELEMENTARY_EXACT];
    counters->tests += lane->separations;
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) counters->tests += lane->decided[i];
}

cscd_status contact_list_reserve_lanes(cscd_detector *d, size_t found) {
    uint32_t lanes = d->traversal.busy_lanes;
    size_t wanted = lanes > 1 && found > CONTACTS_FOR_ALL ? 2 * found / lanes + CONTACTS_FOR_ALL : found;
    for (uint32_t i = 0; lanes > 1 && i < lanes; i++) {
        contact_lane *lane = &d->contact_lanes[i];
        if (lane->capacity >= wanted) continue;
        size_t capacity = wanted + wanted / 2;
        cscd_contact *grown = context_grow(d->context, lane->contacts, lane->count, capacity, sizeof *grown);
        if (grown == NULL) return CSCD_OUT_OF_MEMORY;
        lane->contacts = grown;
        lane->capacity = capacity;
    }
    return CSCD_OK;
}

typedef struct sorted_contacts {
    const sort_key *keys;
    cscd_contact *items;
    size_t count;
} sorted_contacts;

static void copy_contacts(void *data, uint32_t index) {
    const sorted_contacts *s = data;
    size_t begin = (size_t)index * CONTACTS_PER_COPY, end = begin + CONTACTS_PER_COPY;
    for (size_t i = begin; i < end && i < s->count; i++)
        memcpy(&s->items[i], s->keys[i].of, sizeof *s->items);
}

_Static_assert(sizeof(sort_key) == 16 && 2 * sizeof(sort_key) <= sizeof(cscd_contact),
               "keys are sorted where contacts will not be");

cscd_status contact_list_collect(cscd_detector *d, cscd_counters *counters, cscd_contacts *out) {
    size_t found = 0, kept = 0;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) found += d->contact_lanes[i].count;
    cscd_status status = result_buffer_reserve(d->context, &d->contacts, found, sizeof(cscd_contact));
    if (status == CSCD_OK) status = contact_list_reserve_lanes(d, found);
    if (status != CSCD_OK) return status;
    sort_key *keys = d->contacts.scratch;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        const contact_lane *lane = &d->contact_lanes[i];
        add_counters(lane, counters);
        for (size_t j = 0; j < lane->count; j++) {
            const cscd_contact *contact = &lane->contacts[j];
            if (contact_list_leaves_out(d, contact)) continue;
            *(contact->kind == CSCD_CONTACT_VF ? &counters->vf : &counters->ee) += 1;
            counters->bounded += contact->bounded;
            keys[kept++] = (sort_key){bits_of(contact->toi), contact};
        }
    }
    if (kept > 1) sort_contacts(keys, keys + found, kept);
    sorted_contacts sorted = {keys, d->contacts.items, kept};
    uint32_t copies = (uint32_t)((kept + CONTACTS_PER_COPY - 1) / CONTACTS_PER_COPY);
    parallel_run(d->context->threads, copies, copy_contacts, &sorted);
    *out = (cscd_contacts){d->contacts.items, kept};
    return CSCD_OK;
}
