/* Level two of the elementary tests on many pairs at a time, where the cubic has the same sign at both ends:
 * no root, or two. The same intervals and verdicts as cubic.c and inside_test.c have. */
#include "runtime/ccd/ccd_kernels_simd.h"
#include "runtime/ccd/inside_test_simd.h"

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

void SIMD_NAME(two_roots_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                             root_outcomes *out) {
    decide_eight(source, a, b, CSCD_CONTACT_VF, decide_by_two_roots, out);
}

void SIMD_NAME(two_roots_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                             root_outcomes *out) {
    decide_eight(source, a, b, CSCD_CONTACT_EE, decide_by_two_roots, out);
}
