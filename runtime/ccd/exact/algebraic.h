/* Real roots of integer polynomials, and exact signs of other polynomials at them. */
#pragma once

#include "runtime/ccd/exact/polynomial.h"

#include <stdbool.h>

/* One root: which of the distinct real roots of p, ascending from 0. p has degree 1 to 3, no multiple root,
 * and a positive leading coefficient. */
typedef struct algebraic {
    polynomial p;
    int index;
    /* Degree 3: the Sturm chain p, p', linear, a constant with the sign last; how often it changes sign at
     * -infinity. */
    polynomial derivative, linear;
    int last, changes;
    /* Once located: low <= root <= high. */
    bool located;
    double low, high;
} algebraic;

/* The distinct real roots of a, at most 3, in no particular order; none for a constant. What out refers to
 * stays in the pool. */
int algebraic_roots(integer_pool *pool, const polynomial *a, algebraic out[3]);

/* Finds low and high, less than 2^-34 apart, low == high only for a root equal to it. False: the root is not
 * in [0,1]. */
bool algebraic_locate(integer_pool *pool, algebraic *root);

/* The sign of q, of degree 2 at most, at the root: -1, 0 or 1. Faster where the root is located. */
int algebraic_sign(integer_pool *pool, const algebraic *root, const polynomial *q);
