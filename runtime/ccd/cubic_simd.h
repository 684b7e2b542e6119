/* Roots of many cubics: Newton's method, certified intervals, the inside test. The same operations in the
 * same order as cubic.c and inside.c, whose error bounds therefore hold. */
#pragma once

#include "runtime/ccd/feature_pairs_simd.h"

enum { POLISH_STEPS = 10 };

static inline f64w blend(f64w a, f64w b, f64w t) {
    return (1.0 - t) * a + t * b;
}

typedef struct polar {
    f64w low, high;
} polar;

static inline polar polar_at(const f64w b[4], f64w t) {
    f64w p0 = blend(b[0], b[1], t), p1 = blend(b[1], b[2], t), p2 = blend(b[2], b[3], t);
    return (polar){blend(p0, p1, t), blend(p1, p2, t)};
}

static inline f64w value_at(const f64w b[4], f64w t) {
    polar p = polar_at(b, t);
    return blend(p.low, p.high, t);
}

/* Newton's method within [low, high], on the lanes given, where the cubic has the sign `change` before the
 * root and -change after it; returns those in which it converges. */
static inline uint32_t polish(const f64w b[4], uint32_t lanes, f64w low, f64w high, f64w change, f64w *root) {
    const f64w converged = f64w_all(0x1p-26);
    f64w t = *root;
    uint32_t open = lanes;
    for (int i = 0; i < POLISH_STEPS && open != 0; i++) {
        polar p = polar_at(b, t);
        f64w value = blend(p.low, p.high, t), next = t - value / (3.0 * (p.high - p.low));
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

/* A root interval must be as narrow for its begin to be the TOI. */
static inline uint32_t narrow_enough(const intervals_x8 *interval) {
    return f64w_at_most(interval->end - interval->begin, f64w_all(0x1p-31));
}

/* From a guess within [low, high], at whose ends the cubic has the opposite signs `change` and -change, and
 * between which it has exactly one root: the lanes in which that is certainly in the interval. */
static inline uint32_t isolate_between(const f64w b[4], f64w error, uint32_t lanes, f64w low, f64w high,
                                       f64w change, f64w root, intervals_x8 *out) {
    lanes = polish(b, lanes, low, high, change, &root);
    polar p = polar_at(b, root);
    f64w slope = 3.0 * (p.high - p.low);
    f64w radius = 1.25 * (error / f64w_abs(slope)) + 0x1p-50;
    out->begin = f64w_max(root - radius, low);
    out->end = f64w_min(root + radius, high);
    lanes &= f64w_at_most(radius, f64w_all(0x1p-7));
    lanes &= f64w_below(error, change * value_at(b, out->begin));
    return lanes & f64w_below(change * value_at(b, out->end), -error);
}

/* ---- inside ------------------------------------------------------------------------------------------ */

/* Two components of a vector at the middle of the interval, across the axis at hand, and their sizes. */
typedef struct projected {
    f64w y, z, size_y, size_z;
} projected;

typedef struct bounded_value {
    f64w value, error;
} bounded_value;

static inline f64w of_axis(uint32_t first, uint32_t second, f64w a, f64w b, f64w c) {
    return f64w_select(first, a, f64w_select(second, b, c));
}

static inline projected project(const f64w at[3], const f64w size[3], uint32_t x, uint32_t y) {
    return (projected){of_axis(x, y, at[1], at[2], at[0]), of_axis(x, y, at[2], at[0], at[1]),
                       of_axis(x, y, size[1], size[2], size[0]), of_axis(x, y, size[2], size[0], size[1])};
}

static inline bounded_value cross_component(const projected *a, const projected *b, f64w relative_error) {
    f64w size = a->size_y * b->size_z + a->size_z * b->size_y;
    return (bounded_value){a->y * b->z - a->z * b->y, relative_error * size};
}

static inline bounded_value difference(bounded_value a, bounded_value b) {
    return (bounded_value){a.value - b.value, a.error + b.error};
}

/* Lanes in which x is certainly of the sign, and certainly not. */
typedef struct sign_lanes {
    uint32_t right, wrong;
} sign_lanes;

static inline sign_lanes join(sign_lanes so_far, bounded_value x, f64w sign) {
    f64w value = sign * x.value;
    return (sign_lanes){so_far.right & f64w_below(x.error, value),
                        so_far.wrong | f64w_below(value, -x.error)};
}

/* right: they touch at every time in the interval at which they are coplanar; wrong: at none. */
static inline sign_lanes inside(const vectors_x8 *v, cscd_contact_kind kind, const intervals_x8 *interval) {
    f64w t = 0.5 * (interval->begin + interval->end), at[3][3], w3[3];
    f64w h = f64w_max(interval->end - t, t - interval->begin);
    f64w relative_error = 16.0 * 0x1p-53 + 5.0 * h;
    for (int k = 0; k < 3; k++) {
        at[0][k] = blend(v->a[0][k], v->a[1][k], t);
        at[1][k] = blend(v->b[0][k], v->b[1][k], t);
        at[2][k] = blend(v->c[0][k], v->c[1][k], t);
    }
    cross(at[0], at[1], w3);
    for (int k = 0; k < 3; k++) w3[k] = f64w_abs(w3[k]);
    uint32_t x_axis = f64w_at_most(w3[1], w3[0]) & f64w_at_most(w3[2], w3[0]);
    uint32_t y_axis = f64w_at_most(w3[2], w3[1]);
    projected a = project(at[0], v->size_a, x_axis, y_axis), b = project(at[1], v->size_b, x_axis, y_axis),
              c = project(at[2], v->size_c, x_axis, y_axis);

    bounded_value w = cross_component(&a, &b, relative_error);
    uint32_t positive = f64w_below(w.error, w.value), known = positive | f64w_below(w.value, -w.error);
    f64w sign = f64w_select(positive, f64w_all(1.0), f64w_all(-1.0));
    bounded_value u = cross_component(&c, &b, relative_error);
    bounded_value to_v = kind == CSCD_CONTACT_VF ? cross_component(&a, &c, relative_error)
                                                 : cross_component(&c, &a, relative_error);
    bounded_value beyond_u = difference(w, u);
    sign_lanes signs = {ALL_WIDTH, 0};
    signs = join(signs, u, sign);
    signs = join(signs, to_v, sign);
    if (kind == CSCD_CONTACT_EE) signs = join(signs, beyond_u, sign);
    signs = join(signs, difference(kind == CSCD_CONTACT_VF ? beyond_u : w, to_v), sign);
    return (sign_lanes){signs.right & known, signs.wrong & known};
}

/* ---- eight pairs --------------------------------------------------------------------------------------- */

/* What becomes of the pairs i to i + WIDTH - 1 of the eight. */
typedef void decide_some(const points_x8 *points, cscd_contact_kind kind, int i, root_outcomes *out);

static inline void decide_eight(const feature_source *source, const uint32_t *a, const uint32_t *b,
                                cscd_contact_kind kind, decide_some *decide, root_outcomes *out) {
    out->misses = out->hits = 0;
    for (int i = 0; i < LANES; i += WIDTH) {
        points_x8 points;
        load_features(source, kind, a + i, b + i, &points);
        decide(&points, kind, i, out);
    }
}
