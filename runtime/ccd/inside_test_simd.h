/* The inside test of many pairs, each in its own interval. The twin of inside_test.c: the same operations in
 * the same order, so its error bounds hold. */
#pragma once

#include "runtime/ccd/cubic_simd.h"

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
