/* The range of every coordinate and length: 0, or a magnitude from 2^-300 to 2^300. Inside it no product of
 * the exact predicates overflows, and none loses bits below the normal range. */
#pragma once

#include <stdbool.h>

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
