/* Rounding to the scalar in which the caller stores a number. */
#pragma once

#include "cscd/detector.h"
#include "src/core/floating.h"

#include <math.h>

/* The nearest float. `volatile` is needed because gcc 12 drops neighbouring (double)(float) conversions when it joins them into vectors. */
static inline double stored_as_float(double x) {
    volatile float rounded = (float)x;
    return (double)rounded;
}

/* The number of the scalar that is nearest to x. Positions below the least length become 0, as no position may be nearer
 * to it. */
static inline double stored_coordinate(double x, cscd_scalar scalar) {
    if (scalar == CSCD_SCALAR_FLOAT) return stored_as_float(x);
    return fabs(x) < LENGTH_MIN ? 0.0 : x;
}

/* The largest number of the scalar that is not above x >= 0. */
static inline double stored_below(double x, cscd_scalar scalar) {
    if (scalar != CSCD_SCALAR_FLOAT) return x;
    const double rounded = stored_as_float(x);
    return rounded > x ? (double)nextafterf((float)rounded, 0.0f) : rounded;
}
