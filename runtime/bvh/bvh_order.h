/* Orders items in space, so that neighbours in the order are near each other. */
#pragma once

#include "src/core/context.h"

/* A triangle of a region, or a region. */
typedef struct placed_item {
    float centre[3];
    uint32_t name;
} placed_item;

/* Runs of items: run r is items[offsets[r] .. offsets[r + 1]). */
typedef struct item_runs {
    placed_item *items;
    const uint32_t *offsets;
    uint32_t count;
} item_runs;

/* Splits each run at the middle of its longest extent, then each side, down to LANES items; items of one coordinate, and those
 * that end up together, keep their order. All threads share the work, and the result is the same for any number of them.
 * False: no memory, or the call is cancelled, and the items of a run are in any order. */
bool bvh_order_runs(cscd_context *context, item_runs runs);
