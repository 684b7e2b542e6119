/* Guesses a cubic's roots with GSL. The solvers used here call no error handler and cannot fail. */
#include "runtime/ccd/cubic_guess.h"

#include <gsl/gsl_poly.h>
#include <math.h>

/* GSL wants a monic cubic: a leading coefficient as small as this would only spoil the other roots. */
static const double negligible = 0x1p-40;

int cubic_guess_roots(const double c[4], double roots[3]) {
    double size = fmax(fmax(fabs(c[0]), fabs(c[1])), fabs(c[2]));
    if (fabs(c[3]) > negligible * size)
        return gsl_poly_solve_cubic(c[2] / c[3], c[1] / c[3], c[0] / c[3], &roots[0], &roots[1], &roots[2]);
    return gsl_poly_solve_quadratic(c[2], c[1], c[0], &roots[0], &roots[1]);
}
