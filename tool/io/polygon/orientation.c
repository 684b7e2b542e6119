/* Decides orientations in floating point where an error bound allows it, else by expansions, which are sums of doubles
 * without rounding (Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates"). */
#include "tool/io/polygon/orientation.h"

#include <math.h>
#include <stddef.h>

/* The computed determinant is wrong by at most (3 + 16 e) e times the sum of its two products' magnitudes, e = 2^-53
 * (Shewchuk, ccwerrboundA); products that underflow are smaller than 2^-600 here only if they are 0. */
static const double error_bound = (3.0 + 16.0 * 0x1p-53) * 0x1p-53;

/* Adds a number to an expansion of `count` components, which grow in magnitude; the sum has one component more. */
static void grow_expansion(double *expansion, size_t count, double number) {
    double sum = number;
    for (size_t i = 0; i < count; i++) {
        const double part = expansion[i], rounded = sum + part, back = rounded - sum;
        expansion[i] = (sum - (rounded - back)) + (part - back);
        sum = rounded;
    }
    expansion[count] = sum;
}

typedef struct split_number {
    double high, low; /* of 26 bits each */
} split_number;

static split_number split_double(double a) {
    const double scaled = 0x8000001p0 * a, high = scaled - (scaled - a);
    return (split_number){high, a - high};
}

/* What is missing in the rounded product a b (Dekker 1971). Not by fma(), which some C libraries compute in two roundings, as that
 * of mingw-w64 does. */
static double missing_in_product(double a, double b, double product) {
    const split_number x = split_double(a), y = split_double(b);
    return x.low * y.low - (((product - x.high * y.high) - x.low * y.high) - x.high * y.low);
}

/* The sign of ax by - ay bx + bx cy - by cx + cx ay - cy ax, each product as a sum of two doubles. */
static int exact_sign(const double a[2], const double b[2], const double c[2]) {
    const double *const points[4] = {a, b, c, a};
    double expansion[12];
    size_t count = 0;
    for (int i = 0; i < 3; i++) {
        const double *p = points[i], *q = points[i + 1];
        const double forward = p[0] * q[1], backward = -p[1] * q[0];
        grow_expansion(expansion, count++, missing_in_product(p[0], q[1], forward));
        grow_expansion(expansion, count++, forward);
        grow_expansion(expansion, count++, missing_in_product(-p[1], q[0], backward));
        grow_expansion(expansion, count++, backward);
    }
    /* The components do not overlap, so the largest that is not 0 has the sign of the sum. */
    while (count > 0 && expansion[count - 1] == 0.0) count--;
    return count == 0 ? 0 : expansion[count - 1] > 0.0 ? 1 : -1;
}

/* The determinant, and a bound of its error. */
static double find_determinant(const double a[2], const double b[2], const double c[2], double *bound) {
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    *bound = error_bound * (fabs(left) + fabs(right));
    return left - right;
}

int orientation_of(const double a[2], const double b[2], const double c[2]) {
    double bound;
    const double determinant = find_determinant(a, b, c, &bound);
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
    return exact_sign(a, b, c);
}
