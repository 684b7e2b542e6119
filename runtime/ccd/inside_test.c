/* The inside test of level two: are two features' points, coplanar at some time in an interval, in touch?
 *
 * With a, b and c as in point_vectors and W = a x b, a point of the features' common plane has the parameters
 *     u = (c x b) / W,
 *     v = (a x c) / W (VF) or (c x a) / W (EE),
 * each a quotient of components along one axis. The axis with the largest |W| is taken. The features touch if
 * u, v >= 0 and u + v <= 1 (VF) or u, v <= 1 (EE).
 *
 * These are computed at the middle t of the interval; h is its half width. Let u = 2^-53, and A, B the
 * largest magnitudes of components over both ends.
 *     A difference of two points carries a relative error u. Blending two differences at t adds those of 1 -
 *     t, of the products and of the sum. Together these are less than 4.1 u A.
 *     Within the interval the vector itself moves by less than 2.1 h A.
 *     So each component is within r A of the exact one, r = 4.1 u + 2.1 h.
 *     A component of a cross product, a_y b_z - a_z b_y, with the size S = A_y B_z + A_z B_y, is off by (2 r
 *     + r^2) S, and its two products and their difference add less than 2.1 u S: below (10.4 u + 4.3 h) S.
 * The bound used, (16 u + 5 h) S, leaves room for computing it and for the sums of up to three such
 * components, whose bounds are added. Nothing underflows: components are multiples of 2^-352, and blended
 * ones of 2^-460. */
#include "runtime/ccd/elementary_levels.h"
#include "src/core/vec3.h"

/* A number, and how far it may be off. */
typedef struct bounded_value {
    double value, error;
} bounded_value;

/* A moving vector at the middle of the interval. */
typedef struct blended {
    double at[3];
    const double *size;
} blended;

static blended blend_ends(const double ends[2][3], const double size[3], double t) {
    blended out = {.size = size};
    for (int k = 0; k < 3; k++) out.at[k] = (1.0 - t) * ends[0][k] + t * ends[1][k];
    return out;
}

static bounded_value cross_component(const blended *a, const blended *b, int k, double relative_error) {
    static const int next[3] = {1, 2, 0};
    int y = next[k], z = next[y];
    double size = a->size[y] * b->size[z] + a->size[z] * b->size[y];
    return (bounded_value){a->at[y] * b->at[z] - a->at[z] * b->at[y], relative_error * size};
}

static bounded_value subtract_bounded(bounded_value a, bounded_value b) {
    return (bounded_value){a.value - b.value, a.error + b.error};
}

/* Returns 1 when sign * x is certainly above 0, -1 when it is certainly below 0, and 0 when it is unsure. */
static int certain_sign(bounded_value x, double sign) {
    double value = sign * x.value;
    return value > x.error ? 1 : value < -x.error ? -1 : 0;
}

static int largest_axis(const double a[3], const double b[3]) {
    double w[3];
    vec3_cross(a, b, w);
    double x = fabs(w[0]), y = fabs(w[1]), z = fabs(w[2]);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

inside_verdict inside_test(const point_vectors *vectors, cscd_contact_kind kind,
                           const root_interval *interval) {
    double t = 0.5 * (interval->begin + interval->end), h = max_of(interval->end - t, t - interval->begin);
    double relative_error = 16.0 * 0x1p-53 + 5.0 * h;
    blended a = blend_ends(vectors->a, vectors->size_a, t), b = blend_ends(vectors->b, vectors->size_b, t),
            c = blend_ends(vectors->c, vectors->size_c, t);
    int k = largest_axis(a.at, b.at);
    bounded_value w = cross_component(&a, &b, k, relative_error);
    if (certain_sign(w, 1.0) == 0) return INSIDE_UNSURE;

    double sign = w.value > 0.0 ? 1.0 : -1.0;
    bounded_value u = cross_component(&c, &b, k, relative_error);
    bounded_value v = kind == CSCD_CONTACT_VF ? cross_component(&a, &c, k, relative_error)
                                              : cross_component(&c, &a, k, relative_error);
    bounded_value beyond_u = subtract_bounded(w, u);
    const int signs[4] = {certain_sign(u, sign), certain_sign(v, sign),
                          kind == CSCD_CONTACT_VF ? 1 : certain_sign(beyond_u, sign),
                          certain_sign(subtract_bounded(kind == CSCD_CONTACT_VF ? beyond_u : w, v), sign)};
    bool unsure = false;
    for (int i = 0; i < 4; i++) {
        if (signs[i] < 0) return INSIDE_NO;
        unsure |= signs[i] == 0;
    }
    return unsure ? INSIDE_UNSURE : INSIDE_YES;
}
