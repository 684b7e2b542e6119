/* Reproducible random numbers for tests (splitmix64: Steele, Lea, Flood 2014). */
#ifndef CSCD_TEST_RANDOM_H
#define CSCD_TEST_RANDOM_H

#include <stdint.h>

typedef struct random_state {
    uint64_t state;
} random_state;

static inline random_state random_start(uint64_t seed) {
    return (random_state){seed * 0x9e3779b97f4a7c15u + 0x243f6a8885a308d3u};
}

static inline uint64_t random_bits(random_state *random) {
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* 0 .. limit - 1; limit > 0 */
static inline uint32_t random_below(random_state *random, uint32_t limit) {
    return (uint32_t)((random_bits(random) >> 32) * limit >> 32);
}

static inline double random_between(random_state *random, double low, double high) {
    return low + (high - low) * ((double)(random_bits(random) >> 11) * 0x1p-53);
}

#endif
