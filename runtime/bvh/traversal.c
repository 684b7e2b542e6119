/* Self-traversal of the BVH: batches, and how threads share the work. */
#include "runtime/bvh/bvh_parts.h"

#include "src/core/timer.h"

#include <string.h>

/* Shares are block pairs; if possible, there are at least SHARES_PER_WORKER per worker. A BVH of fewer than
 * SHARED_LEAVES_MIN leaves is not worth a second thread. */
enum { STACK_START = 1024, SHARES_PER_WORKER = 128, SHARED_LEAVES_MIN = 96, VISITS_AT_ONCE = 16 };

static bool create_worker(cscd_context *context, traversal_worker *worker) {
    worker->stack_capacity = STACK_START;
    worker->stack = context_allocate(context, STACK_START, sizeof *worker->stack);
    worker->pairs = context_allocate(context, TRAVERSAL_BATCH_SIZE, sizeof *worker->pairs);
    worker->cache.volumes = context_allocate(context, LEAF_CACHE_SIZE + 1, sizeof *worker->cache.volumes);
    return worker->stack != NULL && worker->pairs != NULL && worker->cache.volumes != NULL;
}

static size_t share_room(uint32_t worker_count) {
    size_t wanted = (size_t)worker_count * SHARES_PER_WORKER;
    return (wanted > TRAVERSAL_TASKS_WANTED ? wanted : TRAVERSAL_TASKS_WANTED) + TRAVERSAL_PUSHES_PER_VISIT;
}

cscd_status traversal_create(cscd_context *context, traversal *out) {
    traversal t = {.context = context,
                   .worker_count = parallel_thread_count(context->threads),
                   .tasks_wanted = TRAVERSAL_TASKS_WANTED};
    t.workers = context_allocate(context, t.worker_count, sizeof *t.workers);
    t.shares = context_allocate(context, share_room(t.worker_count), sizeof *t.shares);
    bool allocated = t.workers != NULL && t.shares != NULL;
    for (uint32_t i = 0; allocated && i < t.worker_count; i++)
        allocated = create_worker(context, &t.workers[i]);
    if (!allocated) {
        traversal_destroy(&t);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = t;
    return CSCD_OK;
}

void traversal_destroy(traversal *t) {
    for (uint32_t i = 0; t->workers != NULL && i < t->worker_count; i++) {
        context_free(t->context, t->workers[i].stack);
        context_free(t->context, t->workers[i].pairs);
        context_free(t->context, t->workers[i].cache.volumes);
    }
    context_free(t->context, t->workers);
    context_free(t->context, t->shares);
    *t = (traversal){0};
}

static bool make_room(cscd_context *context, traversal_worker *worker, size_t pushes) {
    if (worker->stack_count + pushes <= worker->stack_capacity) return true;
    size_t capacity = (worker->stack_count + pushes) * 2;
    block_pair *grown =
        context_grow(context, worker->stack, worker->stack_count, capacity, sizeof *worker->stack);
    if (grown == NULL) return false;
    worker->stack = grown;
    worker->stack_capacity = capacity;
    return true;
}

/* Traverses breadth-first on the first worker until there are enough shares, or only leaves below them. */
static bool spread_shares(traversal *t, size_t wanted) {
    traversal_worker *first = &t->workers[0];
    size_t next = 0;
    while (next < first->stack_count && first->stack_count - next < wanted && first->stack[next].level > 0) {
        if (!make_room(t->context, first, TRAVERSAL_PUSHES_PER_VISIT + 1)) return false;
        first->stack[first->stack_count] = first->stack[next++];
        first->stack_count++;
        t->bvh->kernels->search(t, first, 1);
    }
    t->share_count = (uint32_t)(first->stack_count - next);
    memcpy(t->shares, first->stack + next, t->share_count * sizeof *t->shares);
    first->stack_count = 0;
    return true;
}

/* Leaves the root on the first worker. */
static void begin_pass(traversal *t, const bvh *hierarchy, traversal_pass pass) {
    t->bvh = hierarchy;
    t->pass = pass;
    t->skips_inactive = hierarchy->has_inactive && pass != TRAVERSAL_UNPROVEN && !t->whole;
    t->share_count = 0;
    atomic_store(&t->next_share, 0);
    for (uint32_t i = 0; i < t->worker_count; i++) {
        traversal_worker *worker = &t->workers[i];
        worker->stack_count = worker->pair_count = 0;
        worker->boxes_tested = worker->adjacent = worker->pairs_found = 0;
        worker->search_ms = worker->consume_ms = 0.0;
        worker->out_of_memory = false;
        memset(worker->cache.tags, 0, sizeof worker->cache.tags);
    }
    t->workers[0].stack[t->workers[0].stack_count++] = (block_pair){.level = hierarchy->level_count - 1};
}

void traversal_begin(traversal *t, const bvh *hierarchy, traversal_pass pass) {
    begin_pass(t, hierarchy, pass);
    bool large = hierarchy->leaf_count >= SHARED_LEAVES_MIN;
    t->busy_workers = large ? t->worker_count : 1;
    if (large && (t->worker_count > 1 || progress_wanted(&t->context->progress)))
        t->workers[0].out_of_memory = !spread_shares(t, (size_t)t->worker_count * SHARES_PER_WORKER);
}

double traversal_done(const traversal *t) {
    uint32_t taken = atomic_load(&t->next_share);
    return t->share_count > 0 ? (double)taken / t->share_count : 0.0;
}

/* Takes many shares at first, because neighbours have leaves in common, and then fewer and fewer. */
static bool take_shares(traversal *t, traversal_worker *worker) {
    uint32_t next = atomic_load(&t->next_share), count;
    do {
        if (next >= t->share_count || !progress_go_on(&t->context->progress, traversal_done(t))) return false;
        count = (t->share_count - next) / (4 * t->busy_workers) + 1;
    } while (!atomic_compare_exchange_weak(&t->next_share, &next, next + count));
    if (!make_room(t->context, worker, count)) {
        worker->out_of_memory = true;
        return false;
    }
    memcpy(worker->stack + worker->stack_count, t->shares + next, count * sizeof *worker->stack);
    worker->stack_count += count;
    return true;
}

static void fill_batch(traversal *t, traversal_worker *worker, uint32_t enough) {
    worker->pair_count = 0;
    while (worker->pair_count < enough && !worker->out_of_memory) {
        if (worker->stack_count == 0 && !take_shares(t, worker)) return;
        if (!make_room(t->context, worker, TRAVERSAL_PUSHES_PER_VISIT))
            worker->out_of_memory = true;
        else
            t->bvh->kernels->search(t, worker, VISITS_AT_ONCE);
    }
}

bool traversal_fill(traversal *t, uint32_t index) {
    traversal_worker *worker = &t->workers[index];
    double since = timer_now_ms();
    fill_batch(t, worker, TRAVERSAL_BATCH_ENOUGH);
    timer_lap(&since, &worker->search_ms);
    return worker->pair_count > 0;
}

cscd_status traversal_status(const traversal *t) {
    for (uint32_t i = 0; i < t->worker_count; i++) {
        if (t->workers[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    return CSCD_OK;
}

static void fill_worker(void *data, uint32_t index) {
    traversal *t = data;
    fill_batch(t, &t->workers[index], TRAVERSAL_BATCH_SIZE - TRAVERSAL_PAIRS_PER_VISIT + 1);
}

cscd_status traversal_round(traversal *t, bool *more) {
    parallel_run(t->context->threads, t->busy_workers, fill_worker, t);
    *more = false;
    for (uint32_t i = 0; i < t->busy_workers; i++) *more |= t->workers[i].pair_count > 0;
    return traversal_status(t);
}

uint64_t traversal_boxes_tested(const traversal *t) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < t->worker_count; i++) sum += t->workers[i].boxes_tested;
    return sum;
}

/* ---- in tasks ------------------------------------------------------------------------------------------ */

cscd_status traversal_begin_tasks(traversal *t, const bvh *hierarchy, traversal_pass pass) {
    begin_pass(t, hierarchy, pass);
    t->busy_workers = t->worker_count;
    if (!spread_shares(t, t->tasks_wanted)) return CSCD_OUT_OF_MEMORY;
    atomic_store(&t->next_share, t->share_count); /* workers take none by themselves */
    return CSCD_OK;
}

void traversal_begin_task(traversal *t, uint32_t index, uint32_t task) {
    traversal_worker *worker = &t->workers[index];
    worker->stack[0] = t->shares[task];
    worker->stack_count = 1;
}

bool traversal_fill_from_task(traversal *t, uint32_t index) {
    traversal_worker *worker = &t->workers[index];
    fill_batch(t, worker, TRAVERSAL_BATCH_ENOUGH);
    return worker->pair_count > 0 && !worker->out_of_memory;
}
