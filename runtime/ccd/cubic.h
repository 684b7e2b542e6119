/* Finds certified intervals of time that hold the roots of the coplanarity cubic. */
#pragma once

#include "runtime/ccd/coplanarity.h"

typedef struct root_interval {
    double begin, end;
    bool certain; /* the exact cubic has a root in it */
    /* A time that is not above the roots in it, at most 2^-34 below the begin, and the same for every guess; -1 where
     * the interval leaves that open. */
    double toi;
} root_interval;

enum { ROOTS_MAX = 3, ROOTS_UNCERTAIN = -1 };

/* Writes ascending disjoint intervals outside of which the exact cubic has no root in [0,1]. They are as
 * narrow as the cubic's error allows, and below 1/64. Returns how many there are, or ROOTS_UNCERTAIN when
 * that cannot be certified. */
int cubic_isolate(const coplanarity *f, root_interval out[ROOTS_MAX]);

/* Returns the slope of the computed cubic at t in [0,1]. */
double cubic_slope(const coplanarity *f, double t);
