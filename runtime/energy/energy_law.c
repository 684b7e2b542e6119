/* Laws of energies: functions of one distance, with two derivatives. */
#include "runtime/energy/energy.h"

#include "src/core/floating.h"

#include <math.h>

/* ---- a logarithm of the same bits everywhere ------------------------------------------------------------ */

const double logarithm_series[LOGARITHM_TERMS] = {1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,
                                                  1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0,
                                                  1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0};

double natural_logarithm(double x) {
    int k = exponent_of(x);
    double m = x * power_of_two(-(k / 2)) * power_of_two(k / 2 - k); /* -k alone may be no exponent */
    if (m < 0x1.6a09e667f3bcdp-1) {
        m *= 2.0;
        k--;
    }
    double f = m - 1.0, s = f / (2.0 + f), z = s * s, zz = z * z;
    double even = logarithm_series[LOGARITHM_TERMS - 1], odd = logarithm_series[LOGARITHM_TERMS - 2];
    for (int i = LOGARITHM_TERMS - 3; i > 0; i -= 2) {
        even = logarithm_series[i] + zz * even;
        odd = logarithm_series[i - 1] + zz * odd;
    }
    double sum = z * (logarithm_series[0] + zz * even + z * odd);
    /* ln m = 2 s + 2 s sum = f - s (f - 2 sum): f is exact. */
    double tail = s * (f - 2.0 * sum) - k * LOGARITHM_2_LOW;
    return k * LOGARITHM_2_HIGH + (f - tail);
}

/* ---- laws ---------------------------------------------------------------------------------------------- */

/* -(x - r)^2 ln(x / r) for 0 < x < r; infinite where the quotient is below all normal numbers. */
static energy_curve clamped_barrier(double x, double r) {
    if (!(x / r >= 0x1p-1022)) return (energy_curve){INFINITY, 0.0, 0.0};
    double beyond = x - r, share = beyond / x, logarithm = natural_logarithm(x / r);
    return (energy_curve){-beyond * beyond * logarithm, -beyond * (2.0 * logarithm + share),
                          share * (share - 4.0) - 2.0 * logarithm};
}

/* The barrier of x = d^2 - s^2 by d: x' = 2 d, x'' = 2. */
static energy_curve squared_barrier(double d, double s, double r) {
    energy_curve b = clamped_barrier((d - s) * (d + s), r * (2.0 * s + r));
    b.curvature = 2.0 * b.slope + 4.0 * d * d * b.curvature;
    b.slope *= 2.0 * d;
    return b;
}

static double physical_factor(const cscd_energy_options *options, double s) {
    double r = options->reach;
    if (!options->physical) return 1.0;
    if (options->law != CSCD_ENERGY_BARRIER_SQUARED) return 1.0 / r;
    double square = r * (2.0 * s + r);
    return r / (square * square);
}

energy_curve energy_law_at(const cscd_energy_options *options, double distance, double separation) {
    double gap = distance - separation, r = options->reach, left = r - gap;
    bool barrier = options->law == CSCD_ENERGY_BARRIER || options->law == CSCD_ENERGY_BARRIER_SQUARED;
    energy_curve c = {0.0, 0.0, 0.0};
    if (!(gap < r)) return c;
    if (barrier && gap <= 0.0) return (energy_curve){INFINITY, 0.0, 0.0};
    if (options->law == CSCD_ENERGY_BARRIER) c = clamped_barrier(gap, r);
    if (options->law == CSCD_ENERGY_BARRIER_SQUARED) c = squared_barrier(distance, separation, r);
    if (options->law == CSCD_ENERGY_QUADRATIC) c = (energy_curve){0.5 * left * left, -left, 1.0};
    if (options->law == CSCD_ENERGY_CUBIC)
        c = (energy_curve){left * left * left / (6.0 * r), -left * left / (2.0 * r), left / r};
    double factor = physical_factor(options, separation);
    return (energy_curve){factor * c.value, factor * c.slope, factor * c.curvature};
}
