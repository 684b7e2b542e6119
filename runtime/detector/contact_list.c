/* Lists that calls return: their memory, and the contacts of all workers gathered into one sorted list. */
#include "runtime/detector/contact_list.h"

#include "src/core/sort.h"

#include <assert.h>
#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

cscd_status result_buffer_reserve(cscd_context *context, result_buffer *buffer, size_t count,
                                  size_t item_size, size_t key_size) {
    if (count <= buffer->capacity && buffer->keys != NULL) return CSCD_OK;
    result_buffer grown = {.capacity = room_with_spare(count)};
    if (item_size > 0) grown.items = context_allocate(context, grown.capacity, item_size);
    grown.keys = context_allocate(context, grown.capacity, key_size);
    grown.spare_keys = context_allocate(context, grown.capacity, key_size);
    if ((item_size > 0 && grown.items == NULL) || grown.keys == NULL || grown.spare_keys == NULL) {
        result_buffer_free(context, &grown);
        return CSCD_OUT_OF_MEMORY;
    }
    result_buffer_free(context, buffer);
    *buffer = grown;
    return CSCD_OK;
}

/* Gives back what only sorting needs; the items stay. */
static void buffer_free_keys(cscd_context *context, result_buffer *buffer) {
    context_free(context, buffer->keys);
    context_free(context, buffer->spare_keys);
    buffer->keys = buffer->spare_keys = NULL;
}

/* The room of a long list is made in two steps, so that whoever fills it may give back other memory in between: items that
 * hold anything, and then the keys, just enough of them. */
cscd_status result_buffer_reserve_items(cscd_context *context, result_buffer *buffer, size_t count,
                                        size_t item_size) {
    buffer_free_keys(context, buffer);
    if (count <= buffer->capacity && buffer->items != NULL) return CSCD_OK;
    result_buffer_free(context, buffer);
    const size_t room = room_with_spare(count);
    buffer->items = context_reserve(context, room, item_size);
    if (buffer->items == NULL) return CSCD_OUT_OF_MEMORY;
    buffer->capacity = room;
    return CSCD_OK;
}

static cscd_status buffer_reserve_keys(cscd_context *context, result_buffer *buffer, size_t count,
                                       size_t key_size) {
    buffer_free_keys(context, buffer);
    buffer->keys = context_reserve(context, count, key_size);
    buffer->spare_keys = context_reserve(context, count, key_size);
    if (buffer->keys != NULL && buffer->spare_keys != NULL) return CSCD_OK;
    buffer_free_keys(context, buffer);
    return CSCD_OUT_OF_MEMORY;
}

void result_buffer_free(cscd_context *context, result_buffer *buffer) {
    context_free(context, buffer->items);
    buffer_free_keys(context, buffer);
    *buffer = (result_buffer){.capacity = 0};
}

/* ---- gathering ------------------------------------------------------------------------------------- */

/* Up to this number, every worker gets room for all contacts; beyond it, for this number and twice its
 * share of all. */
enum { CONTACTS_FOR_ALL = 4096 };

/* The number of contacts that one thread copies at a time. */
enum { CONTACTS_PER_COPY = 4096 };

/* The number of contacts that a worker finds differs from run to run, so without this a worker might have to grow in an
 * interval that is like the ones before. found: the contacts of all workers together. */
static cscd_status reserve_workers(search_space *s, size_t found) {
    uint32_t workers = s->traversal.busy_workers;
    size_t wanted = workers > 1 && found > CONTACTS_FOR_ALL ? 2 * found / workers + CONTACTS_FOR_ALL : found;
    for (uint32_t i = 0; workers > 1 && i < workers; i++) {
        if (!contact_worker_reserve(s->context, &s->workers[i], wanted)) return CSCD_OUT_OF_MEMORY;
    }
    return CSCD_OK;
}

static size_t count_found(const search_space *s) {
    size_t found = 0;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) found += s->workers[i].count;
    return found;
}

static bool is_too_long(const search_space *s, size_t count) {
    return s->longest > 0 && count > s->longest;
}

static bool is_excluded(const exclusions *e, const cscd_contact *contact) {
    return exclusions_cover(e, contact->kind, contact->a, contact->b, NULL);
}

cscd_status contact_list_gather(search_space *s, const exclusions *e, size_t item_size, result_buffer *buffer,
                                size_t *count) {
    size_t found = count_found(s), kept = 0;
    cscd_status status = result_buffer_reserve(s->context, buffer, found, item_size, sizeof(contact_key));
    if (status == CSCD_OK) status = reserve_workers(s, found);
    if (status != CSCD_OK) return status;
    contact_key *keys = buffer->keys;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        const contact_worker *worker = &s->workers[i];
        for (size_t j = 0; j < worker->count; j++) {
            const cscd_contact *contact = contact_worker_at(worker, j);
            keys[kept] = (contact_key){0, contact};
            kept += j < worker->settled || !is_excluded(e, contact);
        }
    }
    *count = s->counted + kept;
    return is_too_long(s, *count) ? CSCD_LIST_TOO_LONG : CSCD_OK;
}

/* Moves what is kept of a worker to the items, and gives back its memory block by block. */
static size_t move_worker(cscd_context *context, contact_worker *worker, const exclusions *e,
                          cscd_contact *items) {
    size_t kept = 0, i = 0;
    for (uint32_t block = 0; block < worker->block_count; block++) {
        const size_t end = (size_t)WORKER_FIRST_BLOCK << block;
        for (; i < end && i < worker->count; i++) {
            const cscd_contact *contact = contact_worker_at(worker, i);
            if (i >= worker->settled && is_excluded(e, contact)) continue;
            memcpy(&items[kept++], contact, sizeof *items);
        }
        context_free(context, worker->blocks[block]);
        worker->blocks[block] = NULL;
    }
    contact_worker_free(context, worker);
    return kept;
}

/* The same for long lists, which are never there twice: the keys name places of the items. */
static cscd_status gather_long(search_space *s, const exclusions *e, result_buffer *buffer, size_t *count) {
    cscd_status status =
        result_buffer_reserve_items(s->context, buffer, count_found(s), sizeof(cscd_contact));
    if (status != CSCD_OK) return status;
    cscd_contact *items = buffer->items;
    size_t kept = 0;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        if (!progress_go_on(&s->context->progress, 1.0)) return context_progress_status(s->context);
        kept += move_worker(s->context, &s->workers[i], e, items + kept);
    }
    *count = s->counted + kept;
    if (is_too_long(s, *count)) return CSCD_LIST_TOO_LONG;
    status = buffer_reserve_keys(s->context, buffer, kept, sizeof(contact_key));
    if (status != CSCD_OK) return status;
    contact_key *keys = buffer->keys;
    for (size_t i = 0; i < kept; i++) keys[i].contact = &items[i];
    return CSCD_OK;
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

static void add_worker(const contact_worker *worker, cscd_counters *counters) {
    counters->feature_pairs += worker->feature_pairs;
    counters->by_signs += worker->decided[ELEMENTARY_SIGNS];
    counters->by_roots += worker->decided[ELEMENTARY_ROOTS];
    counters->by_exact += worker->decided[ELEMENTARY_EXACT];
    counters->tests += worker->separations;
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) counters->tests += worker->decided[i];
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
    const contact_key *keys; /* NULL: the items are in their places already */
    cscd_contact *items;
    size_t count;
} sorted_contacts;

/* Puts the items in the order of their keys, one round of places that exchange their items after the other. */
static void permute_items(contact_key *keys, cscd_contact *items, size_t count) {
    for (size_t first = 0; first < count; first++) {
        if (keys[first].contact == &items[first]) continue;
        cscd_contact held;
        memcpy(&held, &items[first], sizeof held);
        for (size_t place = first, from;; place = from) {
            from = (size_t)(keys[place].contact - items);
            keys[place].contact = &items[place];
            memcpy(&items[place], from == first ? &held : &items[from], sizeof held);
            if (from == first) break;
        }
    }
}

static void copy_contacts(void *data, uint32_t index) {
    const sorted_contacts *s = data;
    size_t begin = (size_t)index * CONTACTS_PER_COPY, end = begin + CONTACTS_PER_COPY;
    for (size_t i = begin; i < end && i < s->count; i++) {
        if (s->keys != NULL)
            memcpy(&s->items[i], s->keys[i].contact,
                   sizeof *s->items); /* with its padding: lists are compared bit for bit */
        cscd_contact *item = &s->items[i];
        mesh_vertices_of_pair(s->mesh, item->kind, item->a, item->b, item->vertices);
    }
}

cscd_status contact_list_collect(search_space *s, const exclusions *e, result_buffer *buffer,
                                 cscd_counters *counters, cscd_contacts *out) {
    size_t count = 0;
    const bool is_long = count_found(s) >= s->moves_from;
    cscd_status status = is_long ? gather_long(s, e, buffer, &count)
                                 : contact_list_gather(s, e, sizeof(cscd_contact), buffer, &count);
    if (status == CSCD_LIST_TOO_LONG) *out = (cscd_contacts){.count = count};
    if (status != CSCD_OK) return status;
    contact_key *keys = buffer->keys;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) add_worker(&s->workers[i], counters);
    for (size_t i = 0; i < count; i++) {
        keys[i].key = bits_of(keys[i].contact->toi);
        add_contact(keys[i].contact, counters);
    }
    if (count > 1) sort_contacts(keys, buffer->spare_keys, count);
    if (is_long) {
        permute_items(keys, buffer->items, count);
        buffer_free_keys(s->context, buffer);
    }
    sorted_contacts sorted = {s->mesh, is_long ? NULL : keys, buffer->items, count};
    uint32_t copies = (uint32_t)((count + CONTACTS_PER_COPY - 1) / CONTACTS_PER_COPY);
    parallel_run(s->context->threads, copies, copy_contacts, &sorted);
    *out = (cscd_contacts){.items = buffer->items, .count = count};
    return CSCD_OK;
}
