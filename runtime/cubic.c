/* Real roots of a cubic in [0,1]. The one file that knows GSL. */
#include "runtime/cubic.h"

#include <gsl/gsl_poly.h>
#include <math.h>
#include <stdbool.h>

/* Root finding by the two GSL solvers used here involves no error handler of GSL's: they cannot fail. */

enum { POLISH_STEPS = 60 };

typedef struct cubic {
    double c[4]; /* c[0] + c[1] t + c[2] t^2 + c[3] t^3 */
} cubic;

static cubic from_bernstein(const double b[4]) {
    return (cubic){
        {b[0], 3.0 * (b[1] - b[0]), 3.0 * (b[0] - 2.0 * b[1] + b[2]), (b[3] - b[0]) + 3.0 * (b[1] - b[2])}};
}

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

int quadratic_roots(double a, double b, double c, double roots[2]) {
    double found[2] = {0.0, 0.0};
    int count = gsl_poly_solve_quadratic(a, b, c, &found[0], &found[1]), kept = 0;
    for (int i = 0; i < count; i++) {
        if (found[i] >= 0.0 && found[i] <= 1.0) roots[kept++] = found[i];
    }
    return kept;
}

/* GSL wants a monic cubic: a leading coefficient that is small beside the others is divided into them, which
 * costs nothing but accuracy, and accuracy comes from the polish. */
static int approximate_roots(const cubic *f, double roots[3]) {
    double size = fmax(fmax(fabs(f->c[0]), fabs(f->c[1])), fabs(f->c[2]));
    if (fabs(f->c[3]) > 0x1p-40 * size)
        return gsl_poly_solve_cubic(f->c[2] / f->c[3], f->c[1] / f->c[3], f->c[0] / f->c[3], &roots[0],
                                    &roots[1], &roots[2]);
    return gsl_poly_solve_quadratic(f->c[2], f->c[1], f->c[0], &roots[0], &roots[1]);
}

/* The root in [low, high], where f is monotone and changes sign: Newton from start, bisection when it leaves
 * the bracket. */
static double polish(const double b[4], double low, double high, double start) {
    bool rising = bernstein_value(b, high) > 0.0;
    double t = start;
    for (int i = 0; i < POLISH_STEPS; i++) {
        double value = bernstein_value(b, t);
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

static double start_in(double low, double high, const double *guesses, int count) {
    for (int i = 0; i < count; i++) {
        if (guesses[i] > low && guesses[i] < high) return guesses[i];
    }
    return 0.5 * (low + high);
}

/* By a power of two, so that no product of coefficients over- or underflows later. */
static double scale_coefficients(const double b[4], double scaled[4]) {
    int exponent = 0;
    frexp(fmax(fmax(fabs(b[0]), fabs(b[1])), fmax(fabs(b[2]), fabs(b[3]))), &exponent);
    for (int i = 0; i < 4; i++) scaled[i] = ldexp(b[i], -exponent);
    return ldexp(1.0, -exponent);
}

int cubic_roots(const double coefficients[4], double error, double roots[8]) {
    double b[4];
    error *= scale_coefficients(coefficients, b);
    cubic f = from_bernstein(b);
    double guesses[3] = {0.0, 0.0, 0.0}, knots[4] = {0.0, 1.0, 1.0, 1.0};
    int guess_count = approximate_roots(&f, guesses);
    int extremum_count = quadratic_roots(3.0 * f.c[3], 2.0 * f.c[2], f.c[1], &knots[1]);
    int knot_count = extremum_count + 2, count = 0;
    knots[knot_count - 1] = 1.0;

    /* Between knots f is monotone: a sign change there is one root, whether GSL saw it or not. */
    for (int i = 0; i < knot_count; i++) {
        double value = bernstein_value(b, knots[i]);
        if (fabs(value) <= error) roots[count++] = knots[i];
        if (i + 1 == knot_count) break;
        double next = bernstein_value(b, knots[i + 1]);
        if ((value > 0.0 && next < 0.0) || (value < 0.0 && next > 0.0))
            roots[count++] =
                polish(b, knots[i], knots[i + 1], start_in(knots[i], knots[i + 1], guesses, guess_count));
    }
    return count;
}
