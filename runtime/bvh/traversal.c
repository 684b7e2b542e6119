/* Self-traversal of the BVH: batches, and how threads share the work. */
#include "runtime/bvh/bvh_parts.h"

#include "src/core/timer.h"

#include <string.h>

/* Shares are block pairs; if possible, there are at least SHARES_PER_LANE per lane. A BVH of fewer than
 * SHARED_LEAVES_MIN leaves is not worth a second thread. */
enum { STACK_START = 1024, SHARES_PER_LANE = 128, SHARED_LEAVES_MIN = 96, VISITS_AT_ONCE = 16 };

static bool create_lane(cscd_context *context, traversal_lane *lane) {
    lane->stack_capacity = STACK_START;
    lane->stack = context_allocate(context, STACK_START, sizeof *lane->stack);
    lane->pairs = context_allocate(context, TRAVERSAL_BATCH_SIZE, sizeof *lane->pairs);
    lane->cache.volumes = context_allocate(context, LEAF_CACHE_SIZE + 1, sizeof *lane->cache.volumes);
    return lane->stack != NULL && lane->pairs != NULL && lane->cache.volumes != NULL;
}

static size_t share_room(uint32_t lane_count) {
    size_t wanted = (size_t)lane_count * SHARES_PER_LANE;
    return (wanted > TRAVERSAL_TASKS_WANTED ? wanted : TRAVERSAL_TASKS_WANTED) + TRAVERSAL_PUSHES_PER_VISIT;
}

cscd_status traversal_create(cscd_context *context, traversal *out) {
    traversal t = {.context = context,
                   .lane_count = parallel_thread_count(context->threads),
                   .tasks_wanted = TRAVERSAL_TASKS_WANTED};
    t.lanes = context_allocate(context, t.lane_count, sizeof *t.lanes);
    t.shares = context_allocate(context, share_room(t.lane_count), sizeof *t.shares);
    bool allocated = t.lanes != NULL && t.shares != NULL;
    for (uint32_t i = 0; allocated && i < t.lane_count; i++) allocated = create_lane(context, &t.lanes[i]);
    if (!allocated) {
        traversal_destroy(&t);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = t;
    return CSCD_OK;
}

void traversal_destroy(traversal *t) {
    for (uint32_t i = 0; t->lanes != NULL && i < t->lane_count; i++) {
        context_free(t->context, t->lanes[i].stack);
        context_free(t->context, t->lanes[i].pairs);
        context_free(t->context, t->lanes[i].cache.volumes);
    }
    context_free(t->context, t->lanes);
    context_free(t->context, t->shares);
    *t = (traversal){0};
}

static bool make_room(cscd_context *context, traversal_lane *lane, size_t pushes) {
    if (lane->stack_count + pushes <= lane->stack_capacity) return true;
    size_t capacity = (lane->stack_count + pushes) * 2;
    block_pair *grown = context_grow(context, lane->stack, lane->stack_count, capacity, sizeof *lane->stack);
    if (grown == NULL) return false;
    lane->stack = grown;
    lane->stack_capacity = capacity;
    return true;
}

/* Traverses breadth-first on the first lane until there are enough shares, or only leaves below them. */
static bool spread_shares(traversal *t, size_t wanted) {
    traversal_lane *first = &t->lanes[0];
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

/* Leaves the root on the first lane. */
static void begin_pass(traversal *t, const bvh *hierarchy, traversal_pass pass) {
    t->bvh = hierarchy;
    t->pass = pass;
    t->skips_inactive = hierarchy->leaf_inactive != NULL && pass != TRAVERSAL_UNPROVEN && !t->whole;
    t->share_count = 0;
    atomic_store(&t->next_share, 0);
    for (uint32_t i = 0; i < t->lane_count; i++) {
        traversal_lane *lane = &t->lanes[i];
        lane->stack_count = lane->pair_count = 0;
        lane->boxes_tested = lane->adjacent = lane->pairs_found = 0;
        lane->search_ms = lane->consume_ms = 0.0;
        lane->out_of_memory = false;
        memset(lane->cache.tags, 0, sizeof lane->cache.tags);
    }
    t->lanes[0].stack[t->lanes[0].stack_count++] = (block_pair){.level = hierarchy->level_count - 1};
}

void traversal_begin(traversal *t, const bvh *hierarchy, traversal_pass pass) {
    begin_pass(t, hierarchy, pass);
    bool large = hierarchy->leaf_count >= SHARED_LEAVES_MIN;
    t->busy_lanes = large ? t->lane_count : 1;
    if (large && (t->lane_count > 1 || progress_wanted(&t->context->progress)))
        t->lanes[0].out_of_memory = !spread_shares(t, (size_t)t->lane_count * SHARES_PER_LANE);
}

double traversal_done(const traversal *t) {
    uint32_t taken = atomic_load(&t->next_share);
    return t->share_count > 0 ? (double)taken / t->share_count : 0.0;
}

/* Takes many shares at first, because neighbours have leaves in common, and then fewer and fewer. */
static bool take_shares(traversal *t, traversal_lane *lane) {
    uint32_t next = atomic_load(&t->next_share), count;
    do {
        if (next >= t->share_count || !progress_go_on(&t->context->progress, traversal_done(t))) return false;
        count = (t->share_count - next) / (4 * t->busy_lanes) + 1;
    } while (!atomic_compare_exchange_weak(&t->next_share, &next, next + count));
    if (!make_room(t->context, lane, count)) {
        lane->out_of_memory = true;
        return false;
    }
    memcpy(lane->stack + lane->stack_count, t->shares + next, count * sizeof *lane->stack);
    lane->stack_count += count;
    return true;
}

static void fill_batch(traversal *t, traversal_lane *lane, uint32_t enough) {
    lane->pair_count = 0;
    while (lane->pair_count < enough && !lane->out_of_memory) {
        if (lane->stack_count == 0 && !take_shares(t, lane)) return;
        if (!make_room(t->context, lane, TRAVERSAL_PUSHES_PER_VISIT))
            lane->out_of_memory = true;
        else
            t->bvh->kernels->search(t, lane, VISITS_AT_ONCE);
    }
}

bool traversal_fill(traversal *t, uint32_t index) {
    traversal_lane *lane = &t->lanes[index];
    double since = timer_now_ms();
    fill_batch(t, lane, TRAVERSAL_BATCH_ENOUGH);
    timer_lap(&since, &lane->search_ms);
    return lane->pair_count > 0;
}

cscd_status traversal_status(const traversal *t) {
    for (uint32_t i = 0; i < t->lane_count; i++) {
        if (t->lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    return CSCD_OK;
}

static void fill_lane(void *data, uint32_t index) {
    traversal *t = data;
    fill_batch(t, &t->lanes[index], TRAVERSAL_BATCH_SIZE - TRAVERSAL_PAIRS_PER_VISIT + 1);
}

cscd_status traversal_round(traversal *t, bool *more) {
    parallel_run(t->context->threads, t->busy_lanes, fill_lane, t);
    *more = false;
    for (uint32_t i = 0; i < t->busy_lanes; i++) *more |= t->lanes[i].pair_count > 0;
    return traversal_status(t);
}

uint64_t traversal_boxes_tested(const traversal *t) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < t->lane_count; i++) sum += t->lanes[i].boxes_tested;
    return sum;
}

/* ---- in tasks ------------------------------------------------------------------------------------------ */

cscd_status traversal_begin_tasks(traversal *t, const bvh *hierarchy, traversal_pass pass) {
    begin_pass(t, hierarchy, pass);
    t->busy_lanes = t->lane_count;
    if (!spread_shares(t, t->tasks_wanted)) return CSCD_OUT_OF_MEMORY;
    atomic_store(&t->next_share, t->share_count); /* lanes take none by themselves */
    return CSCD_OK;
}

void traversal_begin_task(traversal *t, uint32_t index, uint32_t task) {
    traversal_lane *lane = &t->lanes[index];
    lane->stack[0] = t->shares[task];
    lane->stack_count = 1;
}

bool traversal_fill_from_task(traversal *t, uint32_t index) {
    traversal_lane *lane = &t->lanes[index];
    fill_batch(t, lane, TRAVERSAL_BATCH_ENOUGH);
    return lane->pair_count > 0 && !lane->out_of_memory;
}
