/* Stable sorts that allocate nothing, and sets of numbers that are united. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Sorts count items of size bytes; scratch has room for as many. compare as for qsort. (glibc's qsort takes
 * memory from malloc, behind the back of the context's allocator.) */
void sort_items(void *items, void *scratch, size_t count, size_t size,
                int (*compare)(const void *, const void *));

/* Sorts items of 8 or 16 bytes that begin with a uint64_t by that, ascending, stable; scratch has room for as
 * many. */
void sort_by_number(void *items, void *scratch, size_t count, size_t size);

/* ---- union-find over the numbers 0, 1, 2, ...: the root of a set is its smallest member ---------------- */

/* Makes each number a set of its own. */
static inline void sets_begin(uint32_t *parents, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) parents[i] = i;
}

/* Returns the root of x's set, and halves the path to it. */
static inline uint32_t set_root(uint32_t *parents, uint32_t x) {
    while (parents[x] != x) {
        parents[x] = parents[parents[x]];
        x = parents[x];
    }
    return x;
}

/* Unites the sets of x and y, and returns the root of the union. */
static inline uint32_t set_unite(uint32_t *parents, uint32_t x, uint32_t y) {
    uint32_t a = set_root(parents, x), b = set_root(parents, y);
    uint32_t root = a < b ? a : b;
    parents[a] = parents[b] = root;
    return root;
}
