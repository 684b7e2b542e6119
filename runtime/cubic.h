/* When is a cubic near zero? The one file behind it knows GSL. */
#ifndef CSCD_CUBIC_H
#define CSCD_CUBIC_H

/* A stretch of time in which a cubic is near zero, and the moments in it that may be touches: roots, extrema,
 * and the ends 0 and 1, ascending. */
typedef struct near_zero {
    double begin, end;
    double marks[9];
    int mark_count;
} near_zero;

enum { CUBIC_INTERVALS_MAX = 3 };

/* All t in [0,1] at which the cubic with Bernstein coefficients b (value sum b_i B_i^3(t)) lies within error
 * of zero, error > 0, as ascending disjoint intervals; a root of any multiplicity of a cubic that is nowhere
 * farther than error from this one lies in one of them. Returns how many were written. */
int cubic_near_zero(const double b[4], double error, near_zero out[CUBIC_INTERVALS_MAX]);

#endif
