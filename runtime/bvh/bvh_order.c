/* Orders items in space, so that neighbours in the order are near each other. */
#include "runtime/bvh/bvh_order.h"

#include <math.h>
#include <stdbool.h>

static int longest_axis(const ordering *o, uint32_t begin, uint32_t end) {
    float longest_extent = -1.0f;
    int longest = 0;
    for (int k = 0; k < 3; k++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t i = begin; i < end; i++) {
            float value = o->centres[o->items[i]][k];
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
        if (high - low > longest_extent) {
            longest_extent = high - low;
            longest = k;
        }
    }
    return longest;
}

static bool comes_before(const ordering *o, int axis, uint32_t a, uint32_t b) {
    float x = o->centres[a][axis], y = o->centres[b][axis];
    return x != y ? x < y : a < b;
}

static void swap_items(uint32_t *items, uint32_t i, uint32_t j) {
    uint32_t item = items[i];
    items[i] = items[j];
    items[j] = item;
}

/* Hoare's selection: moves the items of the least coordinates before position nth. */
static void select_nth(const ordering *o, int axis, uint32_t begin, uint32_t end, uint32_t nth) {
    uint32_t *items = o->items;
    while (end - begin > 1) {
        uint32_t pivot = items[begin + (end - begin) / 2], i = begin, j = end - 1;
        for (;;) {
            while (comes_before(o, axis, items[i], pivot)) i++;
            while (comes_before(o, axis, pivot, items[j])) j--;
            if (i >= j) break;
            swap_items(items, i++, j--);
        }
        /* If i and j end on the same item, this is the pivot and already in its place. */
        if (i == j && nth == i) return;
        if (nth < i)
            end = i;
        else
            begin = j + 1;
    }
}

/* Returns the number of items in the first half of a run: the largest power of two below count. So runs of 8^k items
 * begin at multiples of 8^k, and all runs at multiples of their size. */
static uint32_t first_share(uint32_t count) {
    uint32_t share = 1;
    while (share < count - share) share *= 2;
    return share;
}

/* Splits at the middle of the longest extent, then each side, down to single items. */
void bvh_order_run(const ordering *o, uint32_t begin, uint32_t end) {
    uint32_t begins[64], ends[64], depth = 0;
    begins[depth] = begin;
    ends[depth++] = end;
    while (depth > 0) {
        depth--;
        uint32_t from = begins[depth], to = ends[depth];
        if (to - from < 2) continue;
        uint32_t middle = from + first_share(to - from);
        select_nth(o, longest_axis(o, from, to), from, to, middle);
        /* The longer side is pushed first, so the stack holds at most one side per halving. */
        bool first_longer = middle - from > to - middle;
        begins[depth] = first_longer ? from : middle;
        ends[depth++] = first_longer ? middle : to;
        begins[depth] = first_longer ? middle : from;
        ends[depth++] = first_longer ? to : middle;
    }
}
