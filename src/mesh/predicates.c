/* Exact orientation predicates on doubles: a floating-point filter first, exact expansions behind it.
 *
 * Why nothing over- or underflows (rounding to nearest, subnormals not flushed, are assumed). Every
 * coordinate is 0 or lies in [2^-300, 2^300], so it is a multiple of 2^-352 (52 bits below its leading one),
 * and so are sums and differences of coordinates, rounded or not. A product of two of these is a multiple of
 * 2^-704, of three a multiple of 2^-1056, above the spacing 2^-1074 of the smallest doubles. A multiple of
 * 2^-1056 below the normal range (2^-1022) needs at most 34 bits and is a double, so gradual underflow never
 * rounds: each rounding below has a relative error of at most e = 2^-53 and no absolute one. Upwards,
 * differences stay below 2^302 and the sums of all their products of three below 2^910; the split multiplies
 * by 2^27 and sees products of two at most.
 *
 * Exact level: J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric
 * predicates, Discrete & Computational Geometry 18 (1997), SCALE-EXPANSION and LINEAR-EXPANSION-SUM. Both ask
 * for nonoverlapping expansions and return them, so they can be chained in any order. */
#include "src/mesh/predicates.h"

#include <assert.h>
#include <float.h>
#include <math.h>

_Static_assert(FLT_EVAL_METHOD == 0 && DBL_MANT_DIG == 53, "error-free transformations need plain doubles");

/* The exact difference of two doubles, which has at most two terms. */
struct difference {
    int count;
    double term[2];
};

/* A sum of nonoverlapping doubles, none of them 0, smallest first, so that the last has the sign of the
 * whole. A product of two differences has at most 8 terms, a minor 16, a minor times a difference 64, and the
 * sum of three of those 192. */
struct expansion {
    int count;
    double term[192];
};

static inline int sign_of(double value) {
    return (value > 0.0) - (value < 0.0);
}

static inline void append_term(double *term, int *count, double value) {
    if (value != 0.0) term[(*count)++] = value;
}

static struct difference exact_difference(double a, double b) {
    struct difference d = {0, {0.0, 0.0}};
    double head, tail;

    two_sum(a, -b, &head, &tail);
    append_term(d.term, &d.count, tail);
    append_term(d.term, &d.count, head);
    return d;
}

/* SCALE-EXPANSION with zero elimination. */
static void scale_expansion(const double *term, int count, double factor, struct expansion *result) {
    double factor_high, factor_low, sum = 0.0, error;

    split_double(factor, &factor_high, &factor_low);
    result->count = 0;
    for (int i = 0; i < count; i++) {
        double high, low;

        two_product(term[i], factor, factor_high, factor_low, &high, &low);
        two_sum(sum, low, &sum, &error);
        append_term(result->term, &result->count, error);
        fast_two_sum(high, sum, &sum, &error);
        append_term(result->term, &result->count, error);
    }
    append_term(result->term, &result->count, sum);
}

/* LINEAR-EXPANSION-SUM with zero elimination. */
static void add_expansions(const struct expansion *a, const struct expansion *b, struct expansion *result) {
    int i = 0, j = 0;
    double sum = 0.0, rest = 0.0;

    result->count = 0;
    while (i < a->count || j < b->count) {
        bool from_a = j == b->count || (i < a->count && fabs(a->term[i]) < fabs(b->term[j]));
        double next = from_a ? a->term[i++] : b->term[j++];
        double head, tail;

        fast_two_sum(next, rest, &head, &tail);
        append_term(result->term, &result->count, tail);
        two_sum(sum, head, &sum, &rest);
    }
    append_term(result->term, &result->count, rest);
    append_term(result->term, &result->count, sum);
    assert(result->count <= (int)(sizeof result->term / sizeof *result->term));
}

static void multiply_by_difference(const double *term, int count, const struct difference *factor,
                                   struct expansion *result) {
    struct expansion low, high;

    result->count = 0;
    if (factor->count == 1) scale_expansion(term, count, factor->term[0], result);
    if (factor->count < 2) return;
    scale_expansion(term, count, factor->term[0], &low);
    scale_expansion(term, count, factor->term[1], &high);
    add_expansions(&low, &high, result);
}

/* a * d - b * c */
static void exact_minor(const struct difference *a, const struct difference *b, const struct difference *c,
                        const struct difference *d, struct expansion *result) {
    struct expansion ad, bc;

    multiply_by_difference(a->term, a->count, d, &ad);
    multiply_by_difference(b->term, b->count, c, &bc);
    for (int i = 0; i < bc.count; i++) bc.term[i] = -bc.term[i];
    add_expansions(&ad, &bc, result);
}

static int sign_of_expansion(const struct expansion *e) {
    return e->count == 0 ? 0 : sign_of(e->term[e->count - 1]);
}

static int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) {
    struct difference ux = exact_difference(bx, ax), uy = exact_difference(by, ay);
    struct difference vx = exact_difference(cx, ax), vy = exact_difference(cy, ay);
    struct expansion determinant;

    exact_minor(&ux, &uy, &vx, &vy, &determinant);
    return sign_of_expansion(&determinant);
}

static int orient3d_exact(const double a[3], const double b[3], const double c[3], const double d[3]) {
    struct difference u[3], v[3], w[3];
    struct expansion plane, part[3], two_parts, determinant;

    for (int k = 0; k < 3; k++) {
        u[k] = exact_difference(b[k], a[k]);
        v[k] = exact_difference(c[k], a[k]);
        w[k] = exact_difference(d[k], a[k]);
    }
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;

        exact_minor(&u[y], &u[z], &v[y], &v[z], &plane);
        multiply_by_difference(plane.term, plane.count, &w[k], &part[k]);
    }
    add_expansions(&part[0], &part[1], &two_parts);
    add_expansions(&two_parts, &part[2], &determinant);
    return sign_of_expansion(&determinant);
}

/* The filter: left and right carry two differences and a product each, three roundings, at most
 * (1 + e)^3 - 1 < 3e + 4e^2 of the exact magnitude; the last subtraction cannot change the sign. The
 * magnitude is itself computed too small by 4 roundings at most: 3e (1 + 6e) < 4e = 2^-51 bounds the
 * error. */
int orient2d(double ax, double ay, double bx, double by, double cx, double cy) {
    double left = (bx - ax) * (cy - ay);
    double right = (by - ay) * (cx - ax);
    double determinant = left - right;
    double magnitude = fabs(left) + fabs(right);

    if (fabs(determinant) > 0x1p-51 * magnitude) return sign_of(determinant);
    if (magnitude == 0.0) return 0; /* nothing underflows, so every exact product is 0 */
    return orient2d_exact(ax, ay, bx, by, cx, cy);
}

/* The filter: each product of three carries three differences, two products and the subtraction within its
 * minor, and the first of the two last sums, seven roundings; the last sum cannot change the sign. The
 * magnitude is computed too small by 8 roundings at most: 7e (1 + 12e) < 8e = 2^-50 bounds the error. The
 * scaling by 2^-50 alone may round below the normal range, by 2^-1075 at most: above a magnitude of 2^-1003 a
 * part in 2^22 of the bound, which the gap from 7e to 8e covers; below, every value has at most 53 bits above
 * its lowest possible one and the determinant carries no error at all. */
int orient3d(const double a[3], const double b[3], const double c[3], const double d[3]) {
    double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    double wx = d[0] - a[0], wy = d[1] - a[1], wz = d[2] - a[2];
    double uyvz = uy * vz, uzvy = uz * vy;
    double uzvx = uz * vx, uxvz = ux * vz;
    double uxvy = ux * vy, uyvx = uy * vx;
    double determinant = (uyvz - uzvy) * wx + (uzvx - uxvz) * wy + (uxvy - uyvx) * wz;
    double magnitude = (fabs(uyvz) + fabs(uzvy)) * fabs(wx) + (fabs(uzvx) + fabs(uxvz)) * fabs(wy) +
                       (fabs(uxvy) + fabs(uyvx)) * fabs(wz);

    if (fabs(determinant) > 0x1p-50 * magnitude) return sign_of(determinant);
    if (magnitude == 0.0) return 0; /* nothing underflows, so every exact product is 0 */
    return orient3d_exact(a, b, c, d);
}

/* The three orientations are the components of (b - a) x (c - a). */
bool collinear(const double a[3], const double b[3], const double c[3]) {
    return orient2d(a[0], a[1], b[0], b[1], c[0], c[1]) == 0 &&
           orient2d(a[1], a[2], b[1], b[2], c[1], c[2]) == 0 &&
           orient2d(a[2], a[0], b[2], b[0], c[2], c[0]) == 0;
}
