/* 14-DOPs of points in doubles: the volume between pairs of planes across 7 fixed axes. */
#ifndef CSCD_KDOP_H
#define CSCD_KDOP_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

enum { KDOP_AXIS_COUNT = 7, KDOP_BOUND_COUNT = 2 * KDOP_AXIS_COUNT };

/* Axes x, y, z, then the cube's diagonals x+y+z, x+y-z, x-y+z, -x+y+z (not normalised).
 * bounds[i] = -min, bounds[7 + i] = max along axis i: a union is one maximum, 14 wide. */
typedef struct kdop_exact {
    double bounds[KDOP_BOUND_COUNT];
} kdop_exact;

/* Certified bounds of one point. The diagonal sums take two additions: with u = 2^-53 the computed sum is
 * off by at most (2u + u^2)(|x|+|y|+|z|), and computing |x|+|y|+|z| loses at most the same fraction again, so
 * 2^-51 times it covers both and the rounding of the padded bounds themselves (u times their size). */
static inline void kdop_point(const double p[3], kdop_exact *out) {
    double pad = 0x1p-51 * (fabs(p[0]) + fabs(p[1]) + fabs(p[2]));
    double sums[4] = {p[0] + p[1] + p[2], p[0] + p[1] - p[2], p[0] - p[1] + p[2], p[1] + p[2] - p[0]};
    for (int i = 0; i < 3; i++) {
        out->bounds[i] = -p[i];
        out->bounds[KDOP_AXIS_COUNT + i] = p[i];
    }
    for (int i = 0; i < 4; i++) {
        out->bounds[3 + i] = pad - sums[i];
        out->bounds[KDOP_AXIS_COUNT + 3 + i] = pad + sums[i];
    }
}

static inline void kdop_exact_add(kdop_exact *volume, const kdop_exact *other) {
    for (int i = 0; i < KDOP_BOUND_COUNT; i++)
        volume->bounds[i] = volume->bounds[i] > other->bounds[i] ? volume->bounds[i] : other->bounds[i];
}

/* Grown on every side by half of distance, which along the diagonals is sqrt 3 / 2 of it: the volumes of
 * features that are within distance of each other overlap. 2^-51 of a bound covers its rounding. */
static inline void kdop_exact_widen(kdop_exact *volume, double distance) {
    for (int i = 0; i < KDOP_BOUND_COUNT; i++) {
        double bound = volume->bounds[i] + (i % KDOP_AXIS_COUNT < 3 ? 0.5 : 0.866025403785) * distance;
        volume->bounds[i] = bound + 0x1p-51 * fabs(bound);
    }
}

static inline bool kdop_exact_overlap(const kdop_exact *a, const kdop_exact *b) {
    bool apart = false;
    for (int i = 0; i < KDOP_AXIS_COUNT; i++)
        apart |= (a->bounds[KDOP_AXIS_COUNT + i] < -b->bounds[i]) |
                 (b->bounds[KDOP_AXIS_COUNT + i] < -a->bounds[i]);
    return !apart;
}

#endif
