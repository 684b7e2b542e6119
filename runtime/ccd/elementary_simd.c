/* Levels one and two of the elementary tests on many pairs at a time, and the table of all kernels, one per
 * instruction set. The twin of cubic.c, separating_axis.c and inside_test.c: the same operations in the same
 * order, so their error bounds hold. */
#include "runtime/ccd/ccd_simd.h"
#include "runtime/ccd/cubic_simd.h"

/* ---- level one: what separating axes, or the signs of the cubic, prove to be apart --------------------- */

/* The twin of separated_by_axes in separating_axis.c, with the same verdicts: comparisons are exact. */

/* Lanes whose features lie beyond each other along an axis, on the same side at both ends. */
static inline uint32_t separated_by_axes_x8(const points_x8 *p, cscd_contact_kind kind) {
    uint32_t apart = 0;
    for (int k = 0; k < 3; k++) {
        uint32_t before = ALL_WIDTH, beyond = ALL_WIDTH;
        for (int end = 0; end < 2; end++) {
            const f64w(*x)[3] = end == 0 ? p->x0 : p->x1;
            f64w a_low = x[0][k], a_high = x[0][k];
            f64w b_low = f64w_min(x[2][k], x[3][k]), b_high = f64w_max(x[2][k], x[3][k]);
            if (kind == CSCD_CONTACT_EE) {
                a_low = f64w_min(x[0][k], x[1][k]);
                a_high = f64w_max(x[0][k], x[1][k]);
            } else {
                b_low = f64w_min(x[1][k], b_low);
                b_high = f64w_max(x[1][k], b_high);
            }
            before &= f64w_below(a_high, b_low);
            beyond &= f64w_below(b_high, a_low);
        }
        apart |= before | beyond;
    }
    return apart;
}

/* Lanes in which all coefficients lie beyond the error on one side of zero. */
static uint32_t excluded_by_signs(const cubics_x8 *f) {
    uint32_t above = ALL_WIDTH, below = ALL_WIDTH;
    for (int i = 0; i < 4; i++) {
        above &= f64w_below(f->error, f->b[i]);
        below &= f64w_below(f->b[i], -f->error);
    }
    return above | below;
}

static inline uint32_t undecided_lanes(const points_x8 *points, cscd_contact_kind kind) {
    vectors_x8 vectors;
    cubics_x8 f;
    uint32_t undecided = ALL_WIDTH & ~separated_by_axes_x8(points, kind);
    if (undecided == 0) return 0;
    vectors_between(points, kind, &vectors);
    cubics_of(&vectors, &f);
    return undecided & ~excluded_by_signs(&f);
}

/* Pair i moves to place kept, and stays there if kept_now is 1. Branch-free: the outcome is unpredictable. */
static inline uint32_t keep_pair(feature_pairs *pairs, uint32_t i, uint32_t kept_now, uint32_t kept) {
    pairs->a[kept] = pairs->a[i];
    pairs->b[kept] = pairs->b[i];
    return kept + kept_now;
}

/* Fills up the last vector with the last pair. */
static inline void repeat_last(feature_pairs *pairs) {
    for (uint32_t i = 0; i < WIDTH - 1; i++) {
        pairs->a[pairs->count + i] = pairs->a[pairs->count - 1];
        pairs->b[pairs->count + i] = pairs->b[pairs->count - 1];
    }
}

static inline void reject_by_signs(const feature_source *source, feature_pairs *pairs,
                                   cscd_contact_kind kind) {
    uint32_t kept = 0;
    if (pairs->count == 0) return;
    repeat_last(pairs);
    for (uint32_t i = 0; i < pairs->count; i += WIDTH) {
        points_x8 points;
        load_features(source, kind, pairs->a + i, pairs->b + i, &points);
        uint32_t rest = pairs->count - i, real = rest < WIDTH ? (1u << rest) - 1 : ALL_WIDTH;
        uint32_t undecided = real & undecided_lanes(&points, kind);
        for (uint32_t lane = 0; lane < WIDTH; lane++)
            kept = keep_pair(pairs, i + lane, undecided >> lane & 1, kept);
    }
    pairs->count = kept;
}

static void SIMD_NAME(reject_by_signs_vf)(const feature_source *source, feature_pairs *pairs) {
    reject_by_signs(source, pairs, CSCD_CONTACT_VF);
}

static void SIMD_NAME(reject_by_signs_ee)(const feature_source *source, feature_pairs *pairs) {
    reject_by_signs(source, pairs, CSCD_CONTACT_EE);
}

/* ---- the inside test of many pairs, each in its own interval: the twin of inside_test.c ---------------- */

/* Two components of a vector at the middle of the interval, across the chosen axis, and their sizes. */
typedef struct projected {
    f64w y, z, size_y, size_z;
} projected;

typedef struct bounded_x8 {
    f64w value, error;
} bounded_x8;

static inline f64w of_axis(uint32_t first, uint32_t second, f64w a, f64w b, f64w c) {
    return f64w_select(first, a, f64w_select(second, b, c));
}

static inline projected project_across(const f64w at[3], const f64w size[3], uint32_t x, uint32_t y) {
    return (projected){of_axis(x, y, at[1], at[2], at[0]), of_axis(x, y, at[2], at[0], at[1]),
                       of_axis(x, y, size[1], size[2], size[0]), of_axis(x, y, size[2], size[0], size[1])};
}

static inline bounded_x8 cross_component(const projected *a, const projected *b, f64w relative_error) {
    f64w size = a->size_y * b->size_z + a->size_z * b->size_y;
    return (bounded_x8){a->y * b->z - a->z * b->y, relative_error * size};
}

static inline bounded_x8 subtract_bounded(bounded_x8 a, bounded_x8 b) {
    return (bounded_x8){a.value - b.value, a.error + b.error};
}

/* Lanes in which x is certainly of the sign, and certainly not. */
typedef struct sign_lanes {
    uint32_t right, wrong;
} sign_lanes;

static inline sign_lanes join_signs(sign_lanes so_far, bounded_x8 x, f64w sign) {
    f64w value = sign * x.value;
    return (sign_lanes){so_far.right & f64w_below(x.error, value),
                        so_far.wrong | f64w_below(value, -x.error)};
}

/* right: the features touch at every time in the interval at which they are coplanar; wrong: at none. */
static inline sign_lanes inside_test_x8(const vectors_x8 *v, cscd_contact_kind kind,
                                        const intervals_x8 *interval) {
    f64w t = 0.5 * (interval->begin + interval->end), at[3][3], w3[3];
    f64w h = f64w_max(interval->end - t, t - interval->begin);
    f64w relative_error = 16.0 * 0x1p-53 + 5.0 * h;
    for (int k = 0; k < 3; k++) {
        at[0][k] = blend_linearly(v->a[0][k], v->a[1][k], t);
        at[1][k] = blend_linearly(v->b[0][k], v->b[1][k], t);
        at[2][k] = blend_linearly(v->c[0][k], v->c[1][k], t);
    }
    cross_x8(at[0], at[1], w3);
    for (int k = 0; k < 3; k++) w3[k] = f64w_abs(w3[k]);
    uint32_t x_axis = f64w_at_most(w3[1], w3[0]) & f64w_at_most(w3[2], w3[0]);
    uint32_t y_axis = f64w_at_most(w3[2], w3[1]);
    projected a = project_across(at[0], v->size_a, x_axis, y_axis),
              b = project_across(at[1], v->size_b, x_axis, y_axis),
              c = project_across(at[2], v->size_c, x_axis, y_axis);

    bounded_x8 w = cross_component(&a, &b, relative_error);
    uint32_t positive = f64w_below(w.error, w.value), known = positive | f64w_below(w.value, -w.error);
    f64w sign = f64w_select(positive, f64w_all(1.0), f64w_all(-1.0));
    bounded_x8 u = cross_component(&c, &b, relative_error);
    bounded_x8 to_v = kind == CSCD_CONTACT_VF ? cross_component(&a, &c, relative_error)
                                              : cross_component(&c, &a, relative_error);
    bounded_x8 beyond_u = subtract_bounded(w, u);
    sign_lanes signs = {ALL_WIDTH, 0};
    signs = join_signs(signs, u, sign);
    signs = join_signs(signs, to_v, sign);
    if (kind == CSCD_CONTACT_EE) signs = join_signs(signs, beyond_u, sign);
    signs = join_signs(signs, subtract_bounded(kind == CSCD_CONTACT_VF ? beyond_u : w, to_v), sign);
    return (sign_lanes){signs.right & known, signs.wrong & known};
}

/* ---- level two, where the cubic certainly has one root ------------------------------------------------- */

/* Lanes in which the coefficients certainly change sign once: from positive to negative, and back. */
static inline void single_changes(const cubics_x8 *f, uint32_t *falling, uint32_t *rising) {
    uint32_t above[4], below[4];
    for (int i = 0; i < 4; i++) {
        above[i] = f64w_below(f->error, f->b[i]);
        below[i] = f64w_below(f->b[i], -f->error);
    }
    *falling = above[0] & below[3] & (above[1] | below[2]);
    *rising = below[0] & above[3] & (below[1] | above[2]);
}

/* Lanes in which exactly one root is certainly in the interval, and none outside of it. */
static inline uint32_t isolate_single(const cubics_x8 *f, intervals_x8 *out) {
    uint32_t falling, rising;
    single_changes(f, &falling, &rising);
    f64w root = f->b[0] / (f->b[0] - f->b[3]);
    f64w change = f64w_select(falling, f64w_all(1.0), f64w_all(-1.0));
    return isolate_between(f->b, f->error, falling | rising, f64w_all(0.0), f64w_all(1.0), change, root, out);
}

static inline void decide_by_root(const points_x8 *points, cscd_contact_kind kind, int i,
                                  root_outcomes *out) {
    vectors_x8 vectors;
    cubics_x8 f;
    intervals_x8 interval;
    vectors_between(points, kind, &vectors);
    cubics_of(&vectors, &f);
    uint32_t isolated = isolate_single(&f, &interval);
    sign_lanes touching = inside_test_x8(&vectors, kind, &interval);
    out->apart |= (isolated & touching.wrong) << i;
    out->contacts |= (isolated & touching.right & narrow_enough(&interval)) << i;
    memcpy(out->begin + i, &interval.begin, sizeof interval.begin);
}

static void SIMD_NAME(roots_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                                root_outcomes *out) {
    decide_eight(source, a, b, CSCD_CONTACT_VF, decide_by_root, out);
}

static void SIMD_NAME(roots_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                                root_outcomes *out) {
    decide_eight(source, a, b, CSCD_CONTACT_EE, decide_by_root, out);
}

/* ---- level two, where the cubic has the same sign at both ends: no root, or two ------------------------ */

/* A cubic that is above its error at both ends, cut at t: Bernstein coefficients of its two parts are
 * b[0], first, low, value and value, high, last, b[3]. */
typedef struct cut_cubics {
    f64w b[4], t, first, low, value, high, last;
} cut_cubics;

/* Guesses where the cubic is least, if it first falls and rises in the end. That is a root of its slope,
 * whose Bernstein coefficients over 3 are d0 < 0, d1 and d2 > 0. The formula takes ratios, which do not
 * overflow. */
static inline f64w lowest_at(const f64w b[4]) {
    f64w d0 = b[1] - b[0], d1 = b[2] - b[1], d2 = b[3] - b[2];
    f64w half = (d0 - d1) / d0, square = ((d1 - d0) - (d2 - d1)) / d0;
    f64w root = f64w_sqrt(half * half + square);
    uint32_t growing = f64w_at_most(f64w_all(0.0), half);
    return f64w_select(growing, 1.0 / (half + root), (root - half) / square);
}

/* Returns the lanes that are above their errors at both ends, and cut within. */
static inline uint32_t cut_at_lowest(const cubics_x8 *f, cut_cubics *out) {
    f64w zero = f64w_all(0.0), one = f64w_all(1.0);
    f64w sign = f64w_select(f64w_below(zero, f->b[0]), one, -one);
    for (int i = 0; i < 4; i++) out->b[i] = sign * f->b[i];
    const f64w *b = out->b;
    f64w t = out->t = lowest_at(b), middle = blend_linearly(b[1], b[2], t);
    out->first = blend_linearly(b[0], b[1], t);
    out->last = blend_linearly(b[2], b[3], t);
    out->low = blend_linearly(out->first, middle, t);
    out->high = blend_linearly(middle, out->last, t);
    out->value = blend_linearly(out->low, out->high, t);
    return f64w_below(f->error, b[0]) & f64w_below(f->error, b[3]) & f64w_below(zero, t) & f64w_below(t, one);
}

/* Returns the lanes in which all coefficients of both parts are above the error. */
static inline uint32_t without_root(const cut_cubics *c, f64w error) {
    return f64w_below(error, c->first) & f64w_below(error, c->low) & f64w_below(error, c->value) &
           f64w_below(error, c->high) & f64w_below(error, c->last);
}

/* Returns the lanes in which the coefficients of each part certainly change sign once. */
static inline uint32_t with_two_roots(const cut_cubics *c, f64w error) {
    uint32_t left = f64w_below(error, c->first) | f64w_below(c->low, -error);
    uint32_t right = f64w_below(error, c->last) | f64w_below(c->high, -error);
    return left & right & f64w_below(c->value, -error);
}

/* Writes the two roots, one after the other, and returns the lanes in which both are isolated. */
static inline uint32_t isolate_both(const cut_cubics *c, f64w error, uint32_t lanes, intervals_x8 roots[2]) {
    f64w zero = f64w_all(0.0), one = f64w_all(1.0);
    f64w left = c->t * (c->b[0] / (c->b[0] - c->value));
    f64w right = one - (one - c->t) * (c->b[3] / (c->b[3] - c->value));
    lanes = isolate_between(c->b, error, lanes, zero, c->t, one, left, &roots[0]);
    return isolate_between(c->b, error, lanes, c->t, one, -one, right, &roots[1]);
}

static inline void decide_by_two_roots(const points_x8 *points, cscd_contact_kind kind, int i,
                                       root_outcomes *out) {
    vectors_x8 vectors;
    cubics_x8 f;
    cut_cubics parts;
    intervals_x8 roots[2];
    vectors_between(points, kind, &vectors);
    cubics_of(&vectors, &f);
    uint32_t lanes = cut_at_lowest(&f, &parts);
    out->apart |= (lanes & without_root(&parts, f.error)) << i;
    lanes &= with_two_roots(&parts, f.error);
    if (lanes == 0) return;
    lanes = isolate_both(&parts, f.error, lanes, roots);
    if (lanes == 0) return;
    sign_lanes first = inside_test_x8(&vectors, kind, &roots[0]);
    uint32_t contacts = lanes & first.right & narrow_enough(&roots[0]), later = lanes & first.wrong;
    if (later != 0) {
        sign_lanes second = inside_test_x8(&vectors, kind, &roots[1]);
        out->apart |= (later & second.wrong) << i;
        later &= second.right & narrow_enough(&roots[1]);
    }
    f64w begin = f64w_select(contacts, roots[0].begin, roots[1].begin);
    memcpy(out->begin + i, &begin, sizeof begin);
    out->contacts |= (contacts | later) << i;
}

static void SIMD_NAME(two_roots_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                                    root_outcomes *out) {
    decide_eight(source, a, b, CSCD_CONTACT_VF, decide_by_two_roots, out);
}

static void SIMD_NAME(two_roots_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                                    root_outcomes *out) {
    decide_eight(source, a, b, CSCD_CONTACT_EE, decide_by_two_roots, out);
}

/* ---- the table ----------------------------------------------------------------------------------------- */

const ccd_kernels SIMD_NAME(ccd_kernels) = {
    .reject_by_signs_vf = SIMD_NAME(reject_by_signs_vf),
    .reject_by_signs_ee = SIMD_NAME(reject_by_signs_ee),
    .roots_vf = SIMD_NAME(roots_vf),
    .roots_ee = SIMD_NAME(roots_ee),
    .two_roots_vf = SIMD_NAME(two_roots_vf),
    .two_roots_ee = SIMD_NAME(two_roots_ee),
    .describe_vf = SIMD_NAME(describe_vf),
    .describe_ee = SIMD_NAME(describe_ee),
    .proximity_vf = SIMD_NAME(proximity_vf),
    .proximity_ee = SIMD_NAME(proximity_ee),
    .nearest_vf = SIMD_NAME(nearest_vf),
    .nearest_ee = SIMD_NAME(nearest_ee),
};
