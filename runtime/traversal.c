/* Self-traversal of the tree: batches of triangle pairs whose volumes overlap, without recursion. */
#include "runtime/traversal.h"

#include <string.h>

enum { STACK_START = 1024, PUSHES_PER_STEP = 4, PAIRS_PER_LANE = 64 };

cscd_status traversal_create(cscd_context *context, traversal *out) {
    traversal t = {.context = context, .lane_count = parallel_thread_count(context->threads)};
    t.lanes = context_allocate(context, t.lane_count, sizeof *t.lanes);
    bool allocated = t.lanes != NULL;
    for (uint32_t i = 0; allocated && i < t.lane_count; i++) {
        traversal_lane *lane = &t.lanes[i];
        lane->stack_capacity = STACK_START;
        lane->stack = context_allocate(context, STACK_START, sizeof *lane->stack);
        lane->pairs = context_allocate(context, TRAVERSAL_BATCH_SIZE, sizeof *lane->pairs);
        allocated = lane->stack != NULL && lane->pairs != NULL;
    }
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
    }
    context_free(t->context, t->lanes);
    *t = (traversal){0};
}

void traversal_begin(traversal *t, const bvh *tree, traversal_pass pass) {
    t->tree = tree;
    t->pass = pass;
    for (uint32_t i = 0; i < t->lane_count; i++) {
        traversal_lane *lane = &t->lanes[i];
        lane->stack_count = lane->pair_count = 0;
        lane->boxes_tested = 0;
        lane->out_of_memory = false;
    }
    t->lanes[0].stack[t->lanes[0].stack_count++] = (node_pair){0, 0};
}

static void push(traversal_lane *lane, uint32_t a, uint32_t b) {
    lane->stack[lane->stack_count++] = (node_pair){a, b};
}

static void split_self(const bvh_node *nodes, traversal_lane *lane, uint32_t node) {
    if (bvh_is_leaf(&nodes[node])) return;
    uint32_t left = node + 1, right = nodes[node].right;
    push(lane, left, right);
    push(lane, right, right);
    push(lane, left, left);
}

static void split_pair(const bvh_node *nodes, traversal_lane *lane, uint32_t a, uint32_t b) {
    if (bvh_is_leaf(&nodes[a])) {
        push(lane, a, nodes[b].right);
        push(lane, a, b + 1);
    } else if (bvh_is_leaf(&nodes[b])) {
        push(lane, nodes[a].right, b);
        push(lane, a + 1, b);
    } else {
        push(lane, nodes[a].right, nodes[b].right);
        push(lane, nodes[a].right, b + 1);
        push(lane, a + 1, nodes[b].right);
        push(lane, a + 1, b + 1);
    }
}

static void visit(const traversal *t, traversal_lane *lane, node_pair pair) {
    const bvh_node *nodes = t->tree->nodes;
    const uint32_t *marks = t->tree->marks;
    if (t->pass == TRAVERSAL_KEPT && bvh_marks_cull(marks[pair.a], marks[pair.b])) return;
    if (t->pass == TRAVERSAL_FRESH && !bvh_marks_hold_fresh(marks[pair.a], marks[pair.b])) return;
    if (t->pass == TRAVERSAL_SUSPECTS && (marks[pair.a] & marks[pair.b]) == 0) return;
    if (pair.a == pair.b) {
        if (t->pass == TRAVERSAL_UNSEALED && marks[pair.a] != 0) return;
        split_self(nodes, lane, pair.a);
        return;
    }
    const bvh_node *a = &nodes[pair.a], *b = &nodes[pair.b];
    lane->boxes_tested++;
    if (!kdop_overlap(&a->volume, &b->volume)) return;
    if (!bvh_is_leaf(a) || !bvh_is_leaf(b))
        split_pair(nodes, lane, pair.a, pair.b);
    else
        lane->pairs[lane->pair_count++] = (triangle_pair){a->triangle, b->triangle};
}

static bool make_room(cscd_context *context, traversal_lane *lane, size_t pushes) {
    if (lane->stack_count + pushes <= lane->stack_capacity) return true;
    size_t capacity = (lane->stack_count + pushes) * 2;
    node_pair *grown = context_grow(context, lane->stack, lane->stack_count, capacity, sizeof *lane->stack);
    if (grown == NULL) return false;
    lane->stack = grown;
    lane->stack_capacity = capacity;
    return true;
}

static void run_lane(void *data, uint32_t index) {
    traversal *t = data;
    traversal_lane *lane = &t->lanes[index];
    while (lane->stack_count > 0 && lane->pair_count < TRAVERSAL_BATCH_SIZE) {
        if (!make_room(t->context, lane, PUSHES_PER_STEP)) {
            lane->out_of_memory = true;
            return;
        }
        visit(t, lane, lane->stack[--lane->stack_count]);
    }
}

/* Moves all open node pairs to the first lane. */
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

/* Breadth-first on the first lane until there are node pairs enough to share, or its batch is full. */
static bool spread(traversal *t) {
    traversal_lane *first = &t->lanes[0];
    size_t wanted = (size_t)t->lane_count * PAIRS_PER_LANE, next = 0;
    while (next < first->stack_count && first->stack_count - next < wanted &&
           first->pair_count < TRAVERSAL_BATCH_SIZE) {
        if (!make_room(t->context, first, PUSHES_PER_STEP)) return false;
        visit(t, first, first->stack[next++]);
    }
    first->stack_count -= next;
    memmove(first->stack, first->stack + next, first->stack_count * sizeof *first->stack);
    return true;
}

/* Deals the first lane's node pairs out to all lanes like cards: large subtrees and small ones alike. */
static bool deal(traversal *t) {
    traversal_lane *first = &t->lanes[0];
    size_t count = first->stack_count;
    first->stack_count = 0;
    for (size_t i = 0; i < count; i++) {
        node_pair pair = first->stack[i];
        traversal_lane *lane = &t->lanes[i % t->lane_count];
        if (!make_room(t->context, lane, 1)) return false;
        push(lane, pair.a, pair.b);
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
