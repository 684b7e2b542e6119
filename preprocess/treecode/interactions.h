/* Which nodes of the tree act on which others by expansions, and which sources on the targets of which leaf one by one. */
#pragma once

#include "preprocess/treecode/source_tree.h"

/* A source node and the order of the expansion, which are the low 28 and the high 4 bits. */
typedef uint32_t far_item;

enum { FAR_NODE_BITS = 28 };

typedef struct interactions {
    cscd_context *context;
    size_t node_count, leaf_count, far_count, near_count, long_count;
    size_t *far_begins; /* node n has far_items[far_begins[n] .. far_begins[n + 1]), by order */
    far_item *far_items;
    /* Leaf l has near_sources[near_begins[2 l] .. near_begins[2 l + 2]); those from near_begins[2 l + 1] on are far enough for
     * points to stand for them. */
    size_t *near_begins;
    uint32_t *near_sources;
    size_t
        *long_begins; /* node n has long_sources[long_begins[n] .. long_begins[n + 1]): see rank_blocks.h */
    uint32_t *long_sources;
} interactions;

/* Every pair of a source and a target is in one item of one ancestor of the target, far or long, or in one near list. An expansion's error is
 * at most 1 % of the potential that its sources would have if all their charges were positive: with the two balls' radii over the
 * distance of their centres, t, it is t^(p+1) (1 + t) / (1 - t) for order p (the terms of 1 / r in Legendre polynomials). */
cscd_status interactions_create(const source_tree *tree, interactions *out);
void interactions_destroy(interactions *lists);
