/* Real roots of a cubic in [0,1]. The one file behind it knows GSL. */
#ifndef CSCD_CUBIC_H
#define CSCD_CUBIC_H

/* Roots in [0,1], ascending, of the cubic with Bernstein coefficients b (value sum b_i B_i^3(t)), and beside
 * them the extrema in [0,1] at which |value| <= error: there the exact cubic may touch zero. The ends count
 * when their coefficients are within error of zero. Returns how many were written. */
int cubic_roots(const double b[4], double error, double roots[8]);

/* Real roots of a t^2 + b t + c in [0,1], ascending; none when all coefficients are 0. */
int quadratic_roots(double a, double b, double c, double roots[2]);

#endif
