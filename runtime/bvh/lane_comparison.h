/* Which lanes of two blocks, or of two leaves, are compared at all: by flags, obstacles, activity, objects and hidden pairs.
 * Included by the traversal's kernel only. */
#pragma once

#include "runtime/bvh/bvh_kernels_simd.h"

/* A pair of blocks or of leaves whose lanes are compared. */
typedef struct lane_comparison {
    lane_flags a, b;
    lane_flags before_a, before_b; /* flags of leaves before, in the pass NEWLY_KEPT */
    uint64_t self_pairs;
    /* Of blocks: lanes that hold obstacles only, lanes without active triangles and lanes of collapsed components, where
     * the pass skips pairs of two of these, and all of them. */
    uint32_t obstacles_a, obstacles_b, inactive_a, inactive_b, collapsed_a, collapsed_b, resting_a;
    bool itself, one_tree, leaves;
    traversal_pass pass;
} lane_comparison;

static inline uint32_t one_sign(uint32_t plus_a, uint32_t minus_a, uint32_t plus_b, uint32_t minus_b, int i) {
    return (plus_a >> i & 1) != 0 ? plus_b : (minus_a >> i & 1) != 0 ? minus_b : 0;
}

/* Returns those of the lanes of b whose objects are looked at with some of a's. */
static inline uint32_t lanes_looked_at(const object_set *a, const object_set *b, uint32_t lanes) {
    uint32_t kept = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
        int lane = __builtin_ctz(lanes);
        kept |= (uint32_t)object_sets_may_meet(a, &b[lane]) << lane;
    }
    return kept;
}

/* Returns the lanes of b that hold obstacles, nothing active, or collapsed components, as lane i of a. */
static inline uint32_t lanes_at_rest(const lane_comparison *c, int i) {
    uint32_t obstacles = (c->obstacles_a >> i & 1) != 0 ? c->obstacles_b : 0;
    uint32_t inactive = (c->inactive_a >> i & 1) != 0 ? c->inactive_b : 0;
    return obstacles | inactive | ((c->collapsed_a >> i & 1) != 0 ? c->collapsed_b : 0);
}

/* Returns the lanes of b that are to be compared with lane i of a. */
static inline uint32_t lanes_to_compare(const lane_comparison *c, int i) {
    uint32_t lanes = c->b.used;
    if ((c->resting_a >> i & 1) != 0) lanes &= ~lanes_at_rest(c, i);
    if (c->itself) lanes &= (uint32_t)(c->self_pairs >> (8 * i)) & ((uint32_t)ALL_LANES << (i + 1));
    if (c->pass == TRAVERSAL_UNPROVEN) return (c->a.newly_kept >> i & 1) != 0 ? lanes & c->b.newly_kept : 0;
    if (c->pass == TRAVERSAL_NEWLY_KEPT) {
        if (!c->one_tree) return 0;
        if ((c->a.newly_kept >> i & 1) == 0) lanes &= c->b.newly_kept;
        if (c->leaves)
            lanes &= one_sign(c->before_a.plus, c->before_a.minus, c->before_b.plus, c->before_b.minus, i);
    } else if (c->one_tree) {
        lanes &= ~one_sign(c->a.plus, c->a.minus, c->b.plus, c->b.minus, i);
    }
    return lanes;
}
