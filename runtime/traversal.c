/* Self-traversal of the forest: rounds, and how lanes share the work. */
#include "runtime/traversal.h"

#include <string.h>

enum { STACK_START = 1024, PAIRS_PER_LANE = 16 };

static bool create_lane(cscd_context *context, traversal_lane *lane) {
    lane->stack_capacity = STACK_START;
    lane->stack = context_allocate(context, STACK_START, sizeof *lane->stack);
    lane->pairs = context_allocate(context, TRAVERSAL_BATCH_SIZE, sizeof *lane->pairs);
    lane->cache.volumes = context_allocate(context, LEAF_CACHE_SIZE + 1, sizeof *lane->cache.volumes);
    return lane->stack != NULL && lane->pairs != NULL && lane->cache.volumes != NULL;
}

cscd_status traversal_create(cscd_context *context, traversal *out) {
    traversal t = {.context = context, .lane_count = parallel_thread_count(context->threads)};
    t.lanes = context_allocate(context, t.lane_count, sizeof *t.lanes);
    bool allocated = t.lanes != NULL;
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
    *t = (traversal){0};
}

void traversal_begin(traversal *t, const forest *f, traversal_pass pass, bool skip_adjacent) {
    t->forest = f;
    t->pass = pass;
    t->skip_adjacent = skip_adjacent;
    for (uint32_t i = 0; i < t->lane_count; i++) {
        traversal_lane *lane = &t->lanes[i];
        lane->stack_count = lane->pair_count = 0;
        lane->boxes_tested = 0;
        lane->out_of_memory = false;
        memset(lane->cache.tags, 0, sizeof lane->cache.tags);
    }
    t->lanes[0].stack[t->lanes[0].stack_count++] = (block_pair){.level = f->level_count - 1};
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

static bool has_room(const traversal_lane *lane) {
    return lane->pair_count + TRAVERSAL_PAIRS_PER_VISIT <= TRAVERSAL_BATCH_SIZE;
}

static void run_lane(void *data, uint32_t index) {
    const traversal *t = data;
    traversal_lane *lane = &t->lanes[index];
    while (lane->stack_count > 0 && has_room(lane)) {
        if (!make_room(t->context, lane, TRAVERSAL_PUSHES_PER_VISIT)) {
            lane->out_of_memory = true;
            return;
        }
        t->forest->kernels->search(t, lane, SIZE_MAX);
    }
}

/* Moves all open block pairs to the first lane. */
static bool gather(traversal *t) {
    traversal_lane *first = &t->lanes[0];
    for (uint32_t i = 1; i < t->lane_count; i++) {
        traversal_lane *lane = &t->lanes[i];
        if (!make_room(t->context, first, lane->stack_count)) return false;
        memcpy(first->stack + first->stack_count, lane->stack, lane->stack_count * sizeof *lane->stack);
        first->stack_count += lane->stack_count;
        lane->stack_count = 0;
    }
    return true;
}

/* Breadth-first on the first lane until there are block pairs enough to share, or its batch is full. */
static bool spread(traversal *t) {
    traversal_lane *first = &t->lanes[0];
    size_t wanted = (size_t)t->lane_count * PAIRS_PER_LANE, next = 0;
    while (next < first->stack_count && first->stack_count - next < wanted && has_room(first)) {
        if (!make_room(t->context, first, TRAVERSAL_PUSHES_PER_VISIT + 1)) return false;
        first->stack[first->stack_count] = first->stack[next++];
        first->stack_count++;
        t->forest->kernels->search(t, first, 1);
    }
    first->stack_count -= next;
    memmove(first->stack, first->stack + next, first->stack_count * sizeof *first->stack);
    return true;
}

/* Deals the first lane's block pairs out to all lanes like cards: large subtrees and small ones alike. */
static bool deal(traversal *t) {
    traversal_lane *first = &t->lanes[0];
    size_t count = first->stack_count;
    first->stack_count = 0;
    for (size_t i = 0; i < count; i++) {
        block_pair pair = first->stack[i];
        traversal_lane *lane = &t->lanes[i % t->lane_count];
        if (!make_room(t->context, lane, 1)) return false;
        lane->stack[lane->stack_count++] = pair;
    }
    return true;
}

cscd_status traversal_round(traversal *t, bool *more) {
    for (uint32_t i = 0; i < t->lane_count; i++) t->lanes[i].pair_count = 0;
    if (t->lane_count > 1 && !(gather(t) && spread(t) && deal(t))) return CSCD_OUT_OF_MEMORY;
    parallel_run(t->context->threads, t->lane_count, run_lane, t);
    bool any = false;
    for (uint32_t i = 0; i < t->lane_count; i++) {
        if (t->lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
        any |= t->lanes[i].pair_count > 0 || t->lanes[i].stack_count > 0;
    }
    *more = any;
    return CSCD_OK;
}

uint64_t traversal_boxes_tested(const traversal *t) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < t->lane_count; i++) sum += t->lanes[i].boxes_tested;
    return sum;
}
