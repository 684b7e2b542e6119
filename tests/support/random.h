/* Reproducible random numbers: streams, and one stream for a whole test program, which random_seed starts again. */
#pragma once

#include <stdint.h>

typedef struct random_stream {
    uint64_t state;
} random_stream;

static inline uint64_t stream_mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Mixes the seed: otherwise neighbouring seeds would give one stream, shifted. */
static inline random_stream stream_start(uint64_t seed) {
    return (random_stream){stream_mix(seed + 0x243f6a8885a308d3u)};
}

static inline uint64_t stream_bits(random_stream *random) {
    return stream_mix(random->state += 0x9e3779b97f4a7c15u);
}

/* Returns a number in 0 .. limit - 1; limit > 0. */
static inline uint32_t stream_below(random_stream *random, uint32_t limit) {
    return (uint32_t)((stream_bits(random) >> 32) * limit >> 32);
}

static inline double stream_between(random_stream *random, double low, double high) {
    return low + (high - low) * ((double)(stream_bits(random) >> 11) * 0x1p-53);
}

/* ---- one stream for a program -------------------------------------------------------------------------- */

void random_seed(uint64_t seed);

uint64_t random_bits(void);

/* Returns a whole number in [lowest, highest]. */
int random_integer(int lowest, int highest);

/* Returns a number in [-1, 1) that uses all bits of a double. */
double random_unit(void);

/* Returns a number in [low, high], up to rounding. */
double random_between(double low, double high);
