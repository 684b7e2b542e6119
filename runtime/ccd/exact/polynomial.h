/* Polynomials of degree 3 at most with integer coefficients. */
#pragma once

#include "runtime/ccd/exact/integer.h"

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
