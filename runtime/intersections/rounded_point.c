/* Where an edge passes through a triangle, in general position: without integers, where rounding is certain.
 *
 * Numbers are sums of two doubles, high + low, with |low| at most half a unit in the last place of high. Sums and products
 * of such numbers are off by less than 2^-100 of the sum of what they add, or of the product (Joldes, Muller and Popescu
 * 2017: at most 2^-103 for these), and each value has a bound of its error beside it, in which all roundings of the bound
 * itself are a share of 2^-50. Coordinates are 0 or below 2^150, and weights above 2^-500, so nothing overflows, and
 * what underflow loses is below 2^-560 of a result. */
#include "runtime/intersections/rounded_point.h"

#include <math.h>

static const double largest = 0x1p150, least_weight = 0x1p-500, lost = 0x1p-560;

/* ---- sums of two doubles ------------------------------------------------------------------------------- */

typedef struct pair_sum {
    double high, low;
} pair_sum;

static inline pair_sum sum_exactly(double a, double b) {
    double sum = a + b, of_b = sum - a;
    return (pair_sum){sum, (a - (sum - of_b)) + (b - of_b)};
}

/* |a| >= |b| or a = 0. */
static inline pair_sum sum_ordered(double a, double b) {
    double sum = a + b;
    return (pair_sum){sum, b - (sum - a)};
}

static inline pair_sum multiply_exactly(double a, double b) {
    double product = a * b, big_a = 0x1.0000002p27 * a, big_b = 0x1.0000002p27 * b;
    double a_high = big_a - (big_a - a), b_high = big_b - (big_b - b);
    double a_low = a - a_high, b_low = b - b_high;
    double error = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    return (pair_sum){product, error};
}

static inline pair_sum pair_add(pair_sum a, pair_sum b) {
    pair_sum high = sum_exactly(a.high, b.high);
    return sum_ordered(high.high, high.low + (a.low + b.low));
}

static inline pair_sum pair_negate(pair_sum a) {
    return (pair_sum){-a.high, -a.low};
}

static inline pair_sum pair_multiply(pair_sum a, pair_sum b) {
    pair_sum high = multiply_exactly(a.high, b.high);
    return sum_ordered(high.high, high.low + (a.high * b.low + a.low * b.high));
}

static inline pair_sum pair_scale(pair_sum a, double by) {
    pair_sum high = multiply_exactly(a.high, by);
    return sum_ordered(high.high, high.low + a.low * by);
}

/* inverse: 1 / b.high, rounded. What the first product leaves is less than 2^-50 of the quotient; it is off by 3 * 2^-103
 * of it, and the second product by 5 * 2^-53 of itself, so that both are off by less than 2^-99 of the quotient. */
static inline pair_sum pair_divide(pair_sum a, pair_sum b, double inverse) {
    double first = a.high * inverse;
    pair_sum rest = pair_add(a, pair_negate(pair_scale(b, first)));
    return sum_ordered(first, rest.high * inverse);
}

/* ---- weights ------------------------------------------------------------------------------------------- */

/* A value that is not negative, and what it may be off by. */
typedef struct bounded_sum {
    pair_sum value;
    double error;
} bounded_sum;

/* The plane of three points, the first of which is a. */
typedef struct weight_plane {
    const double *a;
    pair_sum normal[3];
    double sizes[3];
} weight_plane;

/* Each coordinate of the normal is off by 3 * 2^-100 of the sum of its two products, its size. */
static weight_plane plane_of_points(const double *a, const double *b, const double *c) {
    weight_plane plane = {.a = a};
    pair_sum u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = sum_exactly(b[k], -a[k]);
        v[k] = sum_exactly(c[k], -a[k]);
    }
    for (int k = 0; k < 3; k++) {
        int x = (k + 1) % 3, y = (k + 2) % 3;
        pair_sum left = pair_multiply(u[x], v[y]), right = pair_multiply(u[y], v[x]);
        plane.normal[k] = pair_add(left, pair_negate(right));
        plane.sizes[k] = fabs(left.high) + fabs(right.high);
    }
    return plane;
}

/* The magnitude of the volume of a plane's points and another one. It is off by 10 * 2^-100 of the sum of its six products.
 * False: it may be 0. */
static bool find_weight(const weight_plane *plane, const double *d, bounded_sum *out) {
    pair_sum sum = {0.0, 0.0};
    double size = 0.0;
    for (int k = 0; k < 3; k++) {
        pair_sum w = sum_exactly(d[k], -plane->a[k]);
        sum = pair_add(sum, pair_multiply(plane->normal[k], w));
        size += plane->sizes[k] * fabs(w.high);
    }
    *out = (bounded_sum){sum.high < 0.0 ? pair_negate(sum) : sum, 0x1p-95 * size};
    return out->value.high > 16.0 * out->error && out->value.high > least_weight;
}

static bounded_sum add_weights(bounded_sum a, bounded_sum b) {
    pair_sum sum = pair_add(a.value, b.value);
    return (bounded_sum){sum, 2.0 * (a.error + b.error) + 0x1p-98 * sum.high};
}

/* ---- results ------------------------------------------------------------------------------------------- */

/* A sum of weights, by which numbers are divided. */
typedef struct divisor {
    bounded_sum sum;
    double inverse;
} divisor;

/* Rounds the quotient of a number, which may be off by error, and a sum of weights. False: it is not certain how. */
static bool round_quotient(pair_sum above, double error, const divisor *below, double *out) {
    pair_sum q = pair_divide(above, below->sum.value, below->inverse);
    double size = fabs(q.high);
    double bound = 2.0 * (error + size * below->sum.error) * below->inverse + 0x1p-96 * size + lost;
    *out = q.high + (q.low + bound);
    return *out == q.high + (q.low - bound);
}

static bool round_coordinate(const bounded_sum weights[2], const divisor *sum, double from, double to,
                             double *out) {
    *out = from + 0.0; /* 0 has no sign */
    if (from == to) return true;
    pair_sum first = pair_scale(weights[0].value, from);
    pair_sum second = pair_scale(weights[1].value, to);
    double error = 2.0 * (weights[0].error * fabs(from) + weights[1].error * fabs(to)) +
                   0x1p-97 * (fabs(first.high) + fabs(second.high));
    return round_quotient(pair_add(first, second), error, sum, out);
}

/* The weights of the triangle's corners add up to what those of the edge's ends add up to: the magnitude of the product of
 * the edge and the triangle's normal. So that of the first corner is not needed, and may be 0. */
bool rounded_point_find(const double *const p[5], event_point *out) {
    bounded_sum ends[2], corners[2]; /* of the second and the third corner */
    for (int i = 0; i < 15; i++) {
        if (!(fabs(p[i / 3][i % 3]) < largest)) return false;
    }
    weight_plane triangle = plane_of_points(p[2], p[3], p[4]), edge = plane_of_points(p[0], p[1], p[2]);
    if (!find_weight(&triangle, p[1], &ends[0]) || !find_weight(&triangle, p[0], &ends[1]) ||
        !find_weight(&edge, p[4], &corners[0]) || !find_weight(&edge, p[3], &corners[1]))
        return false;
    divisor below = {.sum = add_weights(ends[0], ends[1])};
    below.inverse = 1.0 / below.sum.value.high;
    if (!round_quotient(ends[1].value, ends[1].error, &below, &out->s)) return false;
    for (int k = 0; k < 3; k++) {
        if (!round_coordinate(ends, &below, p[0][k], p[1][k], &out->x[k])) return false;
    }
    return round_quotient(corners[0].value, corners[0].error, &below, &out->u) &&
           round_quotient(corners[1].value, corners[1].error, &below, &out->v);
}
