/* Gathers the contacts of all lanes into one sorted list. */
#include "runtime/detector/contact_list.h"

#include "src/core/sort.h"

#include <assert.h>
#include <string.h>

/* Up to this number, every lane gets room for all contacts; beyond it, for this number and twice its
 * share of all. */
enum { CONTACTS_FOR_ALL = 4096 };

/* One thread copies so many contacts at a time. */
enum { CONTACTS_PER_COPY = 4096 };

/* ---- gathering ------------------------------------------------------------------------------------- */

/* The number of contacts that a lane finds differs from run to run, so without this a lane might have to grow in an
 * interval that is like the ones before. found: the contacts of all lanes together. */
static cscd_status reserve_lanes(search_space *s, size_t found) {
    uint32_t lanes = s->traversal.busy_lanes;
    size_t wanted = lanes > 1 && found > CONTACTS_FOR_ALL ? 2 * found / lanes + CONTACTS_FOR_ALL : found;
    for (uint32_t i = 0; lanes > 1 && i < lanes; i++) {
        contact_lane *lane = &s->lanes[i];
        if (lane->capacity >= wanted) continue;
        size_t capacity = wanted + wanted / 2;
        cscd_contact *grown = context_grow(s->context, lane->contacts, lane->count, capacity, sizeof *grown);
        if (grown == NULL) return CSCD_OUT_OF_MEMORY;
        lane->contacts = grown;
        lane->capacity = capacity;
    }
    return CSCD_OK;
}

static bool is_excluded(const exclusions *e, const cscd_contact *contact) {
    return exclusions_any(e) && exclusions_cover_features(e, contact->kind, contact->a, contact->b);
}

cscd_status contact_list_gather(search_space *s, const exclusions *e, size_t item_size, result_buffer *buffer,
                                size_t *count) {
    size_t found = 0, kept = 0;
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) found += s->lanes[i].count;
    cscd_status status = result_buffer_reserve(s->context, buffer, found, item_size, sizeof(contact_key));
    if (status == CSCD_OK) status = reserve_lanes(s, found);
    if (status != CSCD_OK) return status;
    contact_key *keys = buffer->keys;
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) {
        const contact_lane *lane = &s->lanes[i];
        for (size_t j = 0; j < lane->count; j++) {
            keys[kept] = (contact_key){0, &lane->contacts[j]};
            kept += j < lane->settled || !is_excluded(e, &lane->contacts[j]);
        }
    }
    *count = s->counted + kept;
    return s->longest > 0 && *count > s->longest ? CSCD_LIST_TOO_LONG : CSCD_OK;
}

/* ---- sorting --------------------------------------------------------------------------------------- */

/* Non-negative numbers have the same order as their bits. */
static uint64_t bits_of(double toi) {
    uint64_t bits;
    double positive = toi + 0.0; /* turns -0 into 0 */
    assert(toi >= 0.0);
    memcpy(&bits, &positive, sizeof bits);
    return bits;
}

/* Orders contacts that have the same time. */
static int compare_names(const void *left, const void *right) {
    const cscd_contact *l = ((const contact_key *)left)->contact, *r = ((const contact_key *)right)->contact;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

/* Sorts by (toi, kind, a, b). */
static void sort_contacts(contact_key *keys, contact_key *spare, size_t count) {
    sort_by_number(keys, spare, count, sizeof *keys);
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && keys[end].key == keys[begin].key;) end++;
        if (end - begin > 1) sort_items(keys + begin, spare, end - begin, sizeof *keys, compare_names);
    }
}

/* ---- the list -------------------------------------------------------------------------------------- */

static void add_lane(const contact_lane *lane, cscd_counters *counters) {
    counters->feature_pairs += lane->feature_pairs;
    counters->by_signs += lane->decided[ELEMENTARY_SIGNS];
    counters->by_roots += lane->decided[ELEMENTARY_ROOTS];
    counters->by_exact += lane->decided[ELEMENTARY_EXACT];
    counters->tests += lane->separations;
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) counters->tests += lane->decided[i];
}

static void add_contact(const cscd_contact *contact, cscd_counters *counters) {
    bool vf = contact->kind == CSCD_CONTACT_VF, ee = contact->kind == CSCD_CONTACT_EE;
    counters->vf += vf;
    counters->ee += ee;
    counters->loose += !vf && !ee;
    counters->bounded += contact->bounded;
}

typedef struct sorted_contacts {
    const cscd_mesh *mesh;
    const contact_key *keys;
    cscd_contact *items;
    size_t count;
} sorted_contacts;

static void copy_contacts(void *data, uint32_t index) {
    const sorted_contacts *s = data;
    size_t begin = (size_t)index * CONTACTS_PER_COPY, end = begin + CONTACTS_PER_COPY;
    for (size_t i = begin; i < end && i < s->count; i++) {
        memcpy(&s->items[i], s->keys[i].contact,
               sizeof *s->items); /* with its padding: lists are compared bit for bit */
        cscd_contact *item = &s->items[i];
        mesh_vertices_of_pair(s->mesh, item->kind, item->a, item->b, item->vertices);
    }
}

cscd_status contact_list_collect(search_space *s, const exclusions *e, result_buffer *buffer,
                                 cscd_counters *counters, cscd_contacts *out) {
    size_t count;
    cscd_status status = contact_list_gather(s, e, sizeof(cscd_contact), buffer, &count);
    if (status == CSCD_LIST_TOO_LONG) *out = (cscd_contacts){.count = count};
    if (status != CSCD_OK) return status;
    contact_key *keys = buffer->keys;
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) add_lane(&s->lanes[i], counters);
    for (size_t i = 0; i < count; i++) {
        keys[i].key = bits_of(keys[i].contact->toi);
        add_contact(keys[i].contact, counters);
    }
    if (count > 1) sort_contacts(keys, buffer->spare_keys, count);
    sorted_contacts sorted = {s->mesh, keys, buffer->items, count};
    uint32_t copies = (uint32_t)((count + CONTACTS_PER_COPY - 1) / CONTACTS_PER_COPY);
    parallel_run(s->context->threads, copies, copy_contacts, &sorted);
    *out = (cscd_contacts){.items = buffer->items, .count = count};
    return CSCD_OK;
}
