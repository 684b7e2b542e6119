/* The contacts that one thread finds in an interval, and the pairs of features that it still has to test. */
#include "runtime/narrow_phase/contact_worker.h"

#include <string.h>

void contact_worker_reset(contact_worker *worker) {
    worker->count = worker->settled = 0;
    worker->limit = SIZE_MAX;
    worker->suspended = false;
    worker->cursor = 0;
    worker->feature_pairs = 0;
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) worker->decided[i] = 0;
    worker->parted = 0;
    worker->separations = 0;
    worker->out_of_memory = false;
    for (int kind = 0; kind < 2; kind++) worker->queue[kind].count = 0;
    for (int kind = 0; kind < 2; kind++) worker->candidates[kind].count = 0;
}

bool contact_worker_reserve(cscd_context *context, contact_worker *worker, size_t count) {
    while (contact_worker_capacity(worker) < count) {
        const size_t before = contact_worker_capacity(worker),
                     room = before == 0 ? WORKER_FIRST_BLOCK : before;
        cscd_contact *block = context_reserve(context, room, sizeof *block);
        if (block == NULL) return false;
        worker->blocks[worker->block_count++] = block;
    }
    return true;
}

void contact_worker_free(cscd_context *context, contact_worker *worker) {
    while (worker->block_count > 0) context_free(context, worker->blocks[--worker->block_count]);
    worker->count = worker->settled = 0;
}

void contact_worker_add(cscd_context *context, contact_worker *worker, cscd_contact_kind kind, uint32_t a,
                        uint32_t b, const elementary_contact *where, bool bounded) {
    if (!contact_worker_reserve(context, worker, worker->count + 1)) {
        worker->out_of_memory = true;
        return;
    }
    cscd_contact *contact = contact_worker_at(worker, worker->count++);
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

bool contact_worker_reserve_candidates(cscd_context *context, contact_worker *worker, cscd_contact_kind kind,
                                       size_t count) {
    candidate_list *list = &worker->candidates[kind];
    if (count <= list->capacity) return true;
    uint32_t(*grown)[2] = context_grow(context, list->pairs, list->count, count, sizeof *list->pairs);
    if (grown == NULL) return false;
    list->pairs = grown;
    list->capacity = count;
    return true;
}

void contact_worker_add_candidates(cscd_context *context, contact_worker *worker, cscd_contact_kind kind,
                                   const feature_list *pairs) {
    candidate_list *list = &worker->candidates[kind];
    if (list->count + pairs->count > list->capacity &&
        !contact_worker_reserve_candidates(context, worker, kind,
                                           2 * list->capacity + FEATURE_LIST_CAPACITY)) {
        worker->out_of_memory = true;
        return;
    }
    for (uint32_t i = 0; i < pairs->count; i++) {
        list->pairs[list->count][0] = pairs->a[i];
        list->pairs[list->count++][1] = pairs->b[i];
    }
}
