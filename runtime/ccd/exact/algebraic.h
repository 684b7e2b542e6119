/* Real roots of integer polynomials, and exact signs of other polynomials at them. */
#pragma once

#include "runtime/ccd/exact/polynomial.h"

#include <stdbool.h>

/* One real root: number `index`, ascending from 0, of the distinct real roots of p. p has degree 1 to 3, no
 * multiple root, and a positive leading coefficient. */
typedef struct algebraic {
    polynomial p;
    int index;
    /* For degree 3, the Sturm chain is p, p', linear, and a constant with the sign `last`. It changes sign
     * `changes` times at -infinity. */
    polynomial derivative, linear;
    int last, changes;
    /* Set once the root is located: low <= root <= high. */
    bool located;
    double low, high;
    double cell; /* the greatest multiple of ROOT_CELL that is not above the root */
} algebraic;

/* Writes the distinct real roots of a, at most 3, in no particular order, and returns how many there are. A
 * constant has none. The numbers that out refers to stay in the pool. */
int algebraic_roots(integer_pool *pool, const polynomial *a, algebraic out[3]);

/* Finds low and high, less than 2^-34 apart; they are equal only if the root is equal to them. How they are found
 * depends on a guess, but the cell does not. Returns false if the root is not in [0,1]. */
bool algebraic_locate(integer_pool *pool, algebraic *root);

/* Returns the sign of q, of degree 2 at most, at the root: -1, 0 or 1. This is faster once the root is
 * located. */
int algebraic_sign(integer_pool *pool, const algebraic *root, const polynomial *q);
