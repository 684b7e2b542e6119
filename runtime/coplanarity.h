/* The cubic whose roots are the times at which four moving points are coplanar. */
#ifndef CSCD_COPLANARITY_H
#define CSCD_COPLANARITY_H

#include <stdbool.h>

typedef struct coplanarity {
    double b[4];  /* Bernstein coefficients of (A x B) . C */
    double error; /* no computed coefficient, nor a value between them, is farther from the exact one */
} coplanarity;

/* a, b, c: three difference vectors at t = 0 ([0]) and t = 1 ([1]), each the rounded difference of two
 * points. */
coplanarity coplanarity_cubic(const double a[2][3], const double b[2][3], const double c[2][3]);

/* All coefficients beyond the error on one side of zero: the points are never coplanar in [0,1]. */
bool coplanarity_excluded(const coplanarity *f);

#endif
