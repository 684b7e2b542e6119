/* Guesses a cubic's roots by safeguarded Newton steps between the extrema. */

#include "runtime/ccd/elementary_levels.h"

#include <math.h>
#include <stdbool.h>

enum { STEPS_MAX = 100 };

/* A leading coefficient as small as this has its root far outside. */
static const double negligible = 0x1p-40;

/* Roots are looked for a little beyond [0, 1], which is what callers ask for. A step of Newton's method
 * leaves about the square of its length, so after one as short as this nothing is left. */
static const double margin = 0x1p-10, converged = 0x1p-30;

static double value_at(const double c[4], double t) {
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

static double slope_at(const double c[4], double t) {
    return c[1] + t * (2.0 * c[2] + t * (3.0 * c[3]));
}

/* Ascending roots of a t^2 + b t + c in the form that does not cancel. */
static int quadratic_roots(double a, double b, double c, double roots[2]) {
    if (a == 0.0 && b == 0.0) return 0;
    if (a == 0.0) {
        roots[0] = -c / b;
        return 1;
    }
    double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return 0;
    double q = -0.5 * (b + copysign(sqrt(discriminant), b));
    double one = q / a, other = q != 0.0 ? c / q : one;
    roots[0] = one < other ? one : other;
    roots[1] = one < other ? other : one;
    return 2;
}

/* The values at low and high have different signs. A root outside of [0, 1] is left where the search begins. */
static double root_between(const double c[4], double low, double high) {
    const bool rising = value_at(c, high) > 0.0;
    const double sides[2] = {-margin, 1.0 + margin};
    for (int i = 0; i < 2; i++) {
        if (!(sides[i] > low && sides[i] < high)) continue;
        if ((value_at(c, sides[i]) > 0.0) == rising)
            high = sides[i];
        else
            low = sides[i];
    }
    double t = 0.5 * (low + high);
    if (high <= 0.0 || low >= 1.0) return t;
    for (int i = 0; i < STEPS_MAX; i++) {
        double value = value_at(c, t);
        if (value == 0.0) return t;
        if ((value > 0.0) == rising)
            high = t;
        else
            low = t;
        double step = value / slope_at(c, t), next = t - step;
        if (fabs(step) < converged) return next;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (next <= low || next >= high) return t;
        t = next;
    }
    return t;
}

int cubic_guess_roots(const double c[4], double roots[3]) {
    double size = fmax(fmax(fabs(c[0]), fabs(c[1])), fabs(c[2]));
    if (fabs(c[3]) <= negligible * size) return quadratic_roots(c[2], c[1], c[0], roots);

    /* No root lies beyond Cauchy's bound. */
    double bound = 1.0 + size / fabs(c[3]), knots[4] = {-bound};
    int count = 0, extrema = quadratic_roots(3.0 * c[3], 2.0 * c[2], c[1], knots + 1);
    knots[extrema + 1] = bound;
    for (int i = 0; i <= extrema; i++) {
        double low = value_at(c, knots[i]), high = value_at(c, knots[i + 1]);
        if ((low < 0.0 && high > 0.0) || (low > 0.0 && high < 0.0))
            roots[count++] = root_between(c, knots[i], knots[i + 1]);
    }
    return count;
}
