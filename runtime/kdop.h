/* 14-DOPs: the volume between pairs of planes across 7 fixed axes, rounded outward to float. */
#ifndef CSCD_KDOP_H
#define CSCD_KDOP_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

enum { KDOP_AXIS_COUNT = 7, KDOP_BOUND_COUNT = 2 * KDOP_AXIS_COUNT };

/* Axes x, y, z, then the cube's diagonals x+y+z, x+y-z, x-y+z, -x+y+z (not normalised).
 * bounds[i] = -min, bounds[7 + i] = max along axis i: a union is one maximum, 14 wide. */
typedef struct kdop {
    float bounds[KDOP_BOUND_COUNT];
} kdop;

/* The same bounds in double, before rounding to float. */
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

/* A float not below x: rounding to nearest is off by at most 2^-24 |x| (2^-150 below the normal range), less
 * than what is added; above the float range the result is infinite, and -FLT_MAX below it needs no more than
 * the conversion's own overflow to -inf being lifted. */
static inline float round_up(double x) {
    float rounded = (float)(x + (fabs(x) * 0x1p-23 + 0x1p-149));
    return rounded < -3.402823466e+38f ? -3.402823466e+38f : rounded;
}

static inline kdop kdop_round(const kdop_exact *exact) {
    kdop out;
    for (int i = 0; i < KDOP_BOUND_COUNT; i++) out.bounds[i] = round_up(exact->bounds[i]);
    return out;
}

static inline kdop kdop_union(const kdop *a, const kdop *b) {
    kdop out;
    for (int i = 0; i < KDOP_BOUND_COUNT; i++)
        out.bounds[i] = a->bounds[i] > b->bounds[i] ? a->bounds[i] : b->bounds[i];
    return out;
}

static inline kdop kdop_triangle(const kdop *vertex_volumes, const uint32_t vertices[3]) {
    kdop edge = kdop_union(&vertex_volumes[vertices[0]], &vertex_volumes[vertices[1]]);
    return kdop_union(&edge, &vertex_volumes[vertices[2]]);
}

/* Closed: volumes that touch overlap. Written without branches, so that it stays in vector registers. */
static inline bool kdop_overlap(const kdop *a, const kdop *b) {
    int apart = 0;
    for (int i = 0; i < KDOP_AXIS_COUNT; i++) {
        apart |= a->bounds[KDOP_AXIS_COUNT + i] < -b->bounds[i];
        apart |= b->bounds[KDOP_AXIS_COUNT + i] < -a->bounds[i];
    }
    return apart == 0;
}

#endif
