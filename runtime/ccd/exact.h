/* Exact arithmetic on pairs of features: whether they touch while they move, and how far apart they are at
 * rest. */
#pragma once

#include "runtime/ccd/ccd.h"
#include "src/core/integer.h"

/* ---- polynomials of degree 3 at most with integer coefficients ----------------------------------------- */

enum { POLYNOMIAL_DEGREE_MAX = 3 };

/* A polynomial is c[0] + c[1] t + ... + c[degree] t^degree, where c[degree] is not 0. Degree -1 means that it
 * is identically 0. Coefficients beyond the degree are 0. */
typedef struct polynomial {
    int degree;
    integer c[POLYNOMIAL_DEGREE_MAX + 1];
} polynomial;

polynomial polynomial_zero(void);
polynomial polynomial_linear(integer c0, integer c1);
polynomial polynomial_add(integer_pool *pool, const polynomial *a, const polynomial *b);
polynomial polynomial_subtract(integer_pool *pool, const polynomial *a, const polynomial *b);
polynomial polynomial_negate(const polynomial *a);

/* The degrees may add up to 3 at most. */
polynomial polynomial_multiply(integer_pool *pool, const polynomial *a, const polynomial *b);

/* Returns a positive multiple of the remainder of a divided by b. The leading coefficient of b is positive.
 */
polynomial polynomial_remainder(integer_pool *pool, const polynomial *a, const polynomial *b);

/* Returns 1 or -1 when all Bernstein coefficients on [0,1] have that sign, so that there is no root in [0,1].
 * Returns 0 otherwise, and for degrees above 2. */
int polynomial_sign_on_interval(integer_pool *pool, const polynomial *a);

/* Keeps all coefficients, as integer_pool_keep does. */
void polynomial_keep(integer_pool *pool, uint32_t mark, polynomial *a);

/* ---- real roots of integer polynomials, and exact signs of other polynomials at them ------------------- */

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

/* Finds low and high, less than 2^-34 apart; they are equal only if the root is equal to them. The way to
 * them depends on a guess, but the cell does not. Returns false if the root is not in [0,1]. */
bool algebraic_locate(integer_pool *pool, algebraic *root);

/* Returns the sign of q, of degree 2 at most, at the root: -1, 0 or 1. This is faster once the root is
 * located. */
int algebraic_sign(integer_pool *pool, const algebraic *root, const polynomial *q);

/* ---- pairs --------------------------------------------------------------------------------------------- */

/* Level three of the elementary tests. Returns true when the features touch at some t in [0,1]. *toi is then
 * the greatest multiple of 2^-34 that is not above the first such t. Coordinates are 0 or have a magnitude
 * in [2^-300, 2^300]. */
bool exact_touch(const elementary_query *query, cscd_contact_kind kind, double *toi);

/* The same with the caller's pool, whose peak then tells how much room was needed. */
bool exact_touch_in(integer_pool *pool, const elementary_query *query, cscd_contact_kind kind, double *toi);

/* Returns a number that is at most the distance of the features less the length, and at least 1 - 2^-40
 * times that. Returns 0 if they are no farther apart, or by less than 2^-352, which no two coordinates
 * differ by. x: the points, as in an elementary_query. */
double exact_gap(cscd_contact_kind kind, const double x[4][3], double length);
