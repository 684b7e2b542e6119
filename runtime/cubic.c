/* When is a cubic near zero? The one file that knows GSL. */
#include "runtime/cubic.h"

#include <gsl/gsl_poly.h>
#include <math.h>
#include <stdbool.h>

/* Root finding by the two GSL solvers used here involves no error handler of GSL's: they cannot fail. */

enum { POLISH_STEPS = 60 };

/* Two ulp of 1 and more: what a polished root may be off by beside the cubic's own error. */
static const double root_rounding = 0x1p-50;

/* A piece of [0,1] in which the cubic is monotone. */
typedef struct piece {
    double begin, end, value_begin, value_end;
} piece;

/* de Casteljau: stable on [0,1], where the monomial form is not. */
static double bernstein_value(const double b[4], double t) {
    double s = 1.0 - t;
    double p0 = s * b[0] + t * b[1], p1 = s * b[1] + t * b[2], p2 = s * b[2] + t * b[3];
    double q0 = s * p0 + t * p1, q1 = s * p1 + t * p2;
    return s * q0 + t * q1;
}

static double bernstein_slope(const double b[4], double t) {
    double s = 1.0 - t;
    double d0 = b[1] - b[0], d1 = b[2] - b[1], d2 = b[3] - b[2];
    return 3.0 * (s * (s * d0 + t * d1) + t * (s * d1 + t * d2));
}

/* c[0] + c[1] t + c[2] t^2 + c[3] t^3 */
static void to_monomials(const double b[4], double c[4]) {
    c[0] = b[0];
    c[1] = 3.0 * (b[1] - b[0]);
    c[2] = 3.0 * (b[0] - 2.0 * b[1] + b[2]);
    c[3] = (b[3] - b[0]) + 3.0 * (b[1] - b[2]);
}

/* The derivative's roots inside (0,1), ascending. */
static int find_extrema(const double c[4], double extrema[2]) {
    double found[2] = {0.0, 0.0};
    int count = gsl_poly_solve_quadratic(3.0 * c[3], 2.0 * c[2], c[1], &found[0], &found[1]), kept = 0;
    for (int i = 0; i < count; i++) {
        if (found[i] > 0.0 && found[i] < 1.0) extrema[kept++] = found[i];
    }
    return kept;
}

/* Starts for the polish. GSL wants a monic cubic: dividing by a small leading coefficient costs accuracy
 * only, and that comes from the polish; so does any root that GSL overlooks. */
static int approximate_roots(const double c[4], double roots[3]) {
    double size = fmax(fmax(fabs(c[0]), fabs(c[1])), fabs(c[2]));
    if (fabs(c[3]) > 0x1p-40 * size)
        return gsl_poly_solve_cubic(c[2] / c[3], c[1] / c[3], c[0] / c[3], &roots[0], &roots[1], &roots[2]);
    return gsl_poly_solve_quadratic(c[2], c[1], c[0], &roots[0], &roots[1]);
}

/* Where the cubic takes the value level in a piece at whose ends it lies on different sides of it: Newton
 * from start, bisection when that leaves the bracket. */
static double polish(const double b[4], const piece *p, double level, double start) {
    bool rising = p->value_end > p->value_begin;
    double low = p->begin, high = p->end;
    double t = start > low && start < high ? start : 0.5 * (low + high);
    for (int i = 0; i < POLISH_STEPS; i++) {
        double value = bernstein_value(b, t) - level;
        if (value == 0.0) return t;
        if ((value > 0.0) == rising)
            high = t;
        else
            low = t;
        double next = t - value / bernstein_slope(b, t);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (next == t || next <= low || next >= high) return t;
        t = next;
    }
    return t;
}

static double guess_in(const piece *p, const double *guesses, int count) {
    for (int i = 0; i < count; i++) {
        if (guesses[i] > p->begin && guesses[i] < p->end) return guesses[i];
    }
    return 0.5 * (p->begin + p->end);
}

static void add_mark(near_zero *stretch, double t) {
    stretch->marks[stretch->mark_count++] = t;
}

/* A time at or, in the given direction, just past the one at which the cubic takes the value level, which
 * lies between those at the piece's ends. */
static double polish_to(const double b[4], const piece *p, double level, double start, double direction) {
    return polish(b, p, level, start) + direction * root_rounding;
}

/* The same by a step from the root along the slope, when the value there confirms it: mostly it does. */
static double step_to(const double b[4], const piece *p, double level, double root, double direction) {
    double slope = fabs(bernstein_slope(b, root));
    double t = root + direction * (fabs(level) / slope + root_rounding);
    if (t >= p->begin && t <= p->end) {
        double past = fabs(bernstein_value(b, t)) - fabs(level);
        if (past >= 0.0 && past <= 2.0 * root_rounding * slope) return t;
    }
    return polish_to(b, p, level, root, direction);
}

/* The part of a piece in which |value| <= error; false when there is none. */
static bool near_zero_in(const double b[4], double error, const piece *p, double guess, near_zero *out) {
    double from = p->value_begin, to = p->value_end, root = guess;
    if ((from > error && to > error) || (from < -error && to < -error)) return false;
    *out = (near_zero){.begin = p->begin, .end = p->end};
    bool changes_sign = (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0);
    if (changes_sign) root = polish(b, p, 0.0, guess);
    if (fabs(from) <= error) add_mark(out, p->begin);
    if (changes_sign) add_mark(out, root);
    if (fabs(to) <= error) add_mark(out, p->end);
    double (*find)(const double[4], const piece *, double, double, double) =
        changes_sign ? step_to : polish_to;
    if (fabs(from) > error) out->begin = fmax(find(b, p, copysign(error, from), root, -1.0), 0.0);
    if (fabs(to) > error) out->end = fmin(find(b, p, copysign(error, to), root, 1.0), 1.0);
    return true;
}

static void append(near_zero *stretch, const near_zero *next) {
    stretch->end = next->end;
    for (int i = 0; i < next->mark_count; i++) add_mark(stretch, next->marks[i]);
}

/* By a power of two, so that no product of coefficients over- or underflows; returns the factor. */
static double scale_coefficients(const double b[4], double scaled[4]) {
    int exponent = 0;
    frexp(fmax(fmax(fabs(b[0]), fabs(b[1])), fmax(fabs(b[2]), fabs(b[3]))), &exponent);
    for (int i = 0; i < 4; i++) scaled[i] = ldexp(b[i], -exponent);
    return ldexp(1.0, -exponent);
}

int cubic_near_zero(const double coefficients[4], double error, near_zero out[CUBIC_INTERVALS_MAX]) {
    double b[4], c[4], guesses[3] = {0.0, 0.0, 0.0}, knots[4] = {0.0};
    error *= scale_coefficients(coefficients, b);
    to_monomials(b, c);
    int guess_count = approximate_roots(c, guesses);
    int piece_count = find_extrema(c, knots + 1) + 1, count = 0;
    knots[piece_count] = 1.0;
    for (int i = 0; i < piece_count; i++) {
        piece p = {knots[i], knots[i + 1], bernstein_value(b, knots[i]), bernstein_value(b, knots[i + 1])};
        near_zero found;
        if (!near_zero_in(b, error, &p, guess_in(&p, guesses, guess_count), &found)) continue;
        if (count > 0 && found.begin <= out[count - 1].end)
            append(&out[count - 1], &found); /* one stretch about an extremum */
        else
            out[count++] = found;
    }
    return count;
}
