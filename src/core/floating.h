/* Doubles: minimum, maximum, exponent and powers of two without a function call; and the range of coordinates and lengths. */
#pragma once

#if defined(__FAST_MATH__) || __FINITE_MATH_ONLY__ || defined(__NO_SIGNED_ZEROS__)
#error "cscd proves what it says by IEEE arithmetic: compile it without -Ofast and -ffast-math"
#endif

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* These two leave out the treatment of NaN that makes fmax and fmin function calls. */
static inline double max_of(double a, double b) {
    return a > b ? a : b;
}

static inline double min_of(double a, double b) {
    return a < b ? a : b;
}

/* Return a float that is not below x, and one that is not above it. */
static inline float float_above(double x) {
    return (float)(x + __builtin_fabs(x) * 0x1p-23 + 0x1p-120);
}

static inline float float_below(double x) {
    return (float)(x - __builtin_fabs(x) * 0x1p-23 - 0x1p-120);
}

/* Returns the e of x = m 2^e with m in [1/2, 1), as frexp does; 0 for numbers below the normal range. */
static inline int exponent_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int biased = (int)(bits >> 52 & 0x7ff);
    return biased == 0 ? 0 : biased - 1022;
}

/* 2^e, for e from -1022 to 1023. */
static inline double power_of_two(int e) {
    uint64_t bits = (uint64_t)(e + 1023) << 52;
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* ---- the range of coordinates and lengths -------------------------------------------------------------- */

/* The range of every coordinate and length: 0, or a magnitude from 2^-300 to 2^300. Inside it no product of
 * the exact predicates overflows, and none loses bits below the normal range. */
#define LENGTH_MIN 0x1p-300
#define LENGTH_MAX 0x1p300

/* False for 0 and for NaN. */
static inline bool is_positive_length(double x) {
    return x >= LENGTH_MIN && x <= LENGTH_MAX;
}

/* False for NaN. */
static inline bool is_length(double x) {
    return x == 0.0 || is_positive_length(x);
}
