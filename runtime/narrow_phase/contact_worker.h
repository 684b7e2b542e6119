/* The contacts that one thread finds in an interval, and the pairs of features that it still has to test. */
#pragma once

#include "runtime/ccd/ccd.h"
#include "src/core/context.h"

#include <assert.h>

/* Whoever adds up to FEATURE_LIST_BURST pairs asks once whether there is room for them. */
enum { FEATURE_LIST_CAPACITY = 512, FEATURE_LIST_BURST = 16 };

/* Vertex a[i] and triangle b[i], or edges a[i] < b[i]. Kernels fill up their last eight behind the last
 * pair. */
typedef struct feature_list {
    uint32_t count;
    uint32_t a[FEATURE_LIST_CAPACITY + FEATURE_LIST_BURST], b[FEATURE_LIST_CAPACITY + FEATURE_LIST_BURST];
} feature_list;

/* Writes a pair to place count and returns the count with it if `kept` is 1, without it if 0: no branch. */
static inline uint32_t feature_list_put(feature_list *list, uint32_t count, uint32_t a, uint32_t b,
                                        uint32_t kept) {
    assert(count < FEATURE_LIST_CAPACITY + FEATURE_LIST_BURST);
    list->a[count] = a;
    list->b[count] = b;
    return count + kept;
}

static inline bool feature_list_full(const feature_list *list) {
    return list->count + FEATURE_LIST_BURST > FEATURE_LIST_CAPACITY;
}

/* Pairs of features, as in a feature_list. */
typedef struct candidate_list {
    uint32_t (*pairs)[2];
    size_t count, capacity;
} candidate_list;

/* The first block holds WORKER_FIRST_BLOCK contacts, and each later block as many as all blocks before it. */
enum { WORKER_FIRST_BLOCK = 256, WORKER_BLOCKS_MAX = 8 * sizeof(size_t) - 8 };

/* The share of a search that one thread does at a time: the contacts and candidates that it finds, and its queues. */
typedef struct contact_worker {
    _Alignas(CACHE_LINE_SIZE) size_t count;
    uint32_t block_count;
    cscd_contact *blocks[WORKER_BLOCKS_MAX]; /* no contact moves when there are more: see contact_worker_at */
    size_t settled; /* the first ones, of which it is known that they are in the list */
    /* the number of contacts at which the worker is suspended as soon as possible; SIZE_MAX: never */
    size_t limit;
    bool suspended; /* it has more to do, from the cursor on, once there is room */
    uint64_t cursor;
    uint64_t feature_pairs;
    uint64_t decided[ELEMENTARY_LEVEL_COUNT]; /* elementary tests, by the level that decided them */
    uint64_t separations;                     /* tests for minimum separation */
    uint64_t parted;                          /* near pairs that their motion does not bring together */
    bool out_of_memory;
    /* Per component that is culled: pairs of its triangles that came here; NULL: nobody asks. */
    uint32_t *kept;
    feature_list queue[2];        /* by cscd_contact_kind; see feature_queue.h */
    candidate_list candidates[2]; /* by cscd_contact_kind */
} contact_worker;

static inline size_t contact_worker_capacity(const contact_worker *worker) {
    return worker->block_count == 0 ? 0 : (size_t)WORKER_FIRST_BLOCK << (worker->block_count - 1);
}

/* Returns the place of a contact of the worker; i is less than its capacity. */
static inline cscd_contact *contact_worker_at(const contact_worker *worker, size_t i) {
    assert(i < contact_worker_capacity(worker));
    if (i < WORKER_FIRST_BLOCK) return &worker->blocks[0][i];
    const int block = 64 - __builtin_clzll(i / WORKER_FIRST_BLOCK);
    return &worker->blocks[block][i - ((size_t)WORKER_FIRST_BLOCK << (block - 1))];
}

/* Is the worker to be suspended? */
static inline bool contact_worker_full(const contact_worker *worker) {
    return worker->count >= worker->limit;
}

/* Remembers where the worker is to go on; returns whether it is suspended there. */
static inline bool contact_worker_suspend(contact_worker *worker, uint64_t cursor) {
    worker->cursor = cursor;
    return worker->suspended = contact_worker_full(worker);
}

/* Empties the worker; it keeps its memory, and has no limit. */
void contact_worker_reset(contact_worker *worker);

/* Makes room for `count` contacts in all. False: no memory. */
bool contact_worker_reserve(cscd_context *context, contact_worker *worker, size_t count);

/* Gives back the memory of the contacts; the worker has none then. */
void contact_worker_free(cscd_context *context, contact_worker *worker);

/* Both set worker->out_of_memory when there is no room. */
void contact_worker_add(cscd_context *context, contact_worker *worker, cscd_contact_kind kind, uint32_t a,
                        uint32_t b, const elementary_contact *where, bool bounded);
void contact_worker_add_candidates(cscd_context *context, contact_worker *worker, cscd_contact_kind kind,
                                   const feature_list *pairs);

/* Makes room for `count` candidates of a kind in all, and keeps those that are there. False: no memory. */
bool contact_worker_reserve_candidates(cscd_context *context, contact_worker *worker, cscd_contact_kind kind,
                                       size_t count);
