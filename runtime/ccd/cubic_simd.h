/* The coplanarity cubics of many pairs, and their roots: Newton's method and certified intervals. The twin
 * of cubic.c: the same operations in the same order, so its error bounds hold. */
#pragma once

#include "runtime/ccd/ccd_simd.h"

/* ---- the cubics ---------------------------------------------------------------------------------------- */

typedef struct vectors_x8 {
    f64w a[2][3], b[2][3], c[2][3]; /* as in point_vectors */
    f64w size_a[3], size_b[3], size_c[3];
} vectors_x8;

typedef struct cubics_x8 {
    f64w b[4], error;
} cubics_x8;

static inline void subtract_at_ends(const points_x8 *points, int to, int from, f64w out[2][3], f64w size[3]) {
    for (int k = 0; k < 3; k++) {
        out[0][k] = points->x0[to][k] - points->x0[from][k];
        out[1][k] = points->x1[to][k] - points->x1[from][k];
        size[k] = f64w_max(f64w_abs(out[0][k]), f64w_abs(out[1][k]));
    }
}

static inline void vectors_between(const points_x8 *points, cscd_contact_kind kind, vectors_x8 *out) {
    int vf = kind == CSCD_CONTACT_VF;
    subtract_at_ends(points, vf ? 2 : 1, vf ? 1 : 0, out->a, out->size_a);
    subtract_at_ends(points, 3, vf ? 1 : 2, out->b, out->size_b);
    subtract_at_ends(points, vf ? 0 : 2, vf ? 1 : 0, out->c, out->size_c);
}

static inline void cubics_of(const vectors_x8 *v, cubics_x8 *f) {
    f64w start[3], end[3], one[3], other[3], mixed[3], permanent = f64w_all(0.0);
    cross_x8(v->a[0], v->b[0], start);
    cross_x8(v->a[1], v->b[1], end);
    cross_x8(v->a[1], v->b[0], one);
    cross_x8(v->a[0], v->b[1], other);
    for (int k = 0; k < 3; k++) mixed[k] = one[k] + other[k];
    f->b[0] = dot_x8(start, v->c[0]);
    f->b[1] = (dot_x8(mixed, v->c[0]) + dot_x8(start, v->c[1])) / 3.0;
    f->b[2] = (dot_x8(mixed, v->c[1]) + dot_x8(end, v->c[0])) / 3.0;
    f->b[3] = dot_x8(end, v->c[1]);
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        permanent += v->size_c[k] * (v->size_a[y] * v->size_b[z] + v->size_a[z] * v->size_b[y]);
    }
    f->error = 24.0 * 0x1p-53 * permanent + 0x1p-1060;
}

/* ---- their roots --------------------------------------------------------------------------------------- */

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
