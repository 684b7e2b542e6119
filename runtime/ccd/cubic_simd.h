/* Roots of many cubics: Newton's method and certified intervals. The twin of cubic.c: the same operations in
 * the same order, so its error bounds hold. */
#pragma once

#include "runtime/ccd/coplanarity_simd.h"

enum { POLISH_STEPS = 10 };

static inline f64w blend_linearly(f64w a, f64w b, f64w t) {
    return (1.0 - t) * a + t * b;
}

typedef struct polar_x8 {
    f64w low, high;
} polar_x8;

static inline polar_x8 polar_at(const f64w b[4], f64w t) {
    f64w p0 = blend_linearly(b[0], b[1], t), p1 = blend_linearly(b[1], b[2], t),
         p2 = blend_linearly(b[2], b[3], t);
    return (polar_x8){blend_linearly(p0, p1, t), blend_linearly(p1, p2, t)};
}

static inline f64w value_at(const f64w b[4], f64w t) {
    polar_x8 p = polar_at(b, t);
    return blend_linearly(p.low, p.high, t);
}

/* Newton's method on the given lanes, kept within [low, high]. The cubic has the sign `change` before the
 * root and -change after it. Returns the lanes in which the method converges. */
static inline uint32_t polish_root(const f64w b[4], uint32_t lanes, f64w low, f64w high, f64w change,
                                   f64w *root) {
    const f64w converged = f64w_all(0x1p-26);
    f64w t = *root;
    uint32_t open = lanes;
    for (int i = 0; i < POLISH_STEPS && open != 0; i++) {
        polar_x8 p = polar_at(b, t);
        f64w value = blend_linearly(p.low, p.high, t), next = t - value / (3.0 * (p.high - p.low));
        f64w side = change * value;
        low = f64w_select(f64w_below(f64w_all(0.0), side), t, low);
        high = f64w_select(f64w_below(side, f64w_all(0.0)), t, high);
        next = f64w_select(f64w_at_most(low, next) & f64w_at_most(next, high), next, 0.5 * (low + high));
        f64w step = f64w_abs(next - t);
        t = f64w_select(open, next, t);
        open &= ~f64w_below(step, converged);
    }
    *root = t;
    return lanes & ~open;
}

typedef struct intervals_x8 {
    f64w begin, end;
} intervals_x8;

/* A root interval must be this narrow for its begin to be the TOI. */
static inline uint32_t narrow_enough(const intervals_x8 *interval) {
    return f64w_at_most(interval->end - interval->begin, f64w_all(0x1p-31));
}

/* Isolates the root in [low, high], from a guess. At the ends the cubic has the opposite signs `change` and
 * -change, and between them it has exactly one root. Returns the lanes in which the root is certainly in the
 * interval. */
static inline uint32_t isolate_between(const f64w b[4], f64w error, uint32_t lanes, f64w low, f64w high,
                                       f64w change, f64w root, intervals_x8 *out) {
    lanes = polish_root(b, lanes, low, high, change, &root);
    polar_x8 p = polar_at(b, root);
    f64w slope = 3.0 * (p.high - p.low);
    f64w radius = 1.25 * (error / f64w_abs(slope)) + 0x1p-50;
    out->begin = f64w_max(root - radius, low);
    out->end = f64w_min(root + radius, high);
    lanes &= f64w_at_most(radius, f64w_all(0x1p-7));
    lanes &= f64w_below(error, change * value_at(b, out->begin));
    return lanes & f64w_below(change * value_at(b, out->end), -error);
}
