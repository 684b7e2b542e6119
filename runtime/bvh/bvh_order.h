/* Orders items in space, so that neighbours in the order are near each other. */
#pragma once

#include <stdint.h>

/* Items to be ordered: the triangles of a region, or regions. */
typedef struct ordering {
    uint32_t *items;
    float (*centres)[3]; /* indexed by what items holds */
} ordering;

/* Splits items begin to end - 1 at the middle of the longest extent, then each side, down to single items. */
void bvh_order_run(const ordering *o, uint32_t begin, uint32_t end);
