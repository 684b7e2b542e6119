/* Union-find over numbers 0, 1, 2, ...: a set's root is its smallest member. */
#pragma once

#include <stdint.h>

/* With path halving. */
static inline uint32_t set_root(uint32_t *parents, uint32_t x) {
    while (parents[x] != x) {
        parents[x] = parents[parents[x]];
        x = parents[x];
    }
    return x;
}

/* The root of the union. */
static inline uint32_t set_unite(uint32_t *parents, uint32_t x, uint32_t y) {
    uint32_t a = set_root(parents, x), b = set_root(parents, y);
    uint32_t root = a < b ? a : b;
    parents[a] = parents[b] = root;
    return root;
}
