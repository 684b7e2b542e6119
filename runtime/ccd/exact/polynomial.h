/* Polynomials of degree 3 at most with integer coefficients. */
#pragma once

#include "runtime/ccd/exact/integer.h"

enum { POLYNOMIAL_DEGREE_MAX = 3 };

/* c[0] + c[1] t + ... + c[degree] t^degree, c[degree] not 0; degree -1: identically 0. Coefficients beyond
 * the degree are 0. */
typedef struct polynomial {
    int degree;
    integer c[POLYNOMIAL_DEGREE_MAX + 1];
} polynomial;

polynomial polynomial_zero(void);
polynomial polynomial_linear(integer c0, integer c1);
polynomial polynomial_add(integer_pool *pool, const polynomial *a, const polynomial *b);
polynomial polynomial_subtract(integer_pool *pool, const polynomial *a, const polynomial *b);
polynomial polynomial_negate(const polynomial *a);

/* Degrees add up to 3 at most. */
polynomial polynomial_multiply(integer_pool *pool, const polynomial *a, const polynomial *b);

/* A positive multiple of the remainder of a divided by b, whose leading coefficient is positive. */
polynomial polynomial_remainder(integer_pool *pool, const polynomial *a, const polynomial *b);

/* 1 or -1: all Bernstein coefficients on [0,1] have that sign, so that there is no root in [0,1]; 0: not so,
 * or the degree is above 2. */
int polynomial_sign_on_interval(integer_pool *pool, const polynomial *a);

/* integer_pool_keep for all coefficients. */
void polynomial_keep(integer_pool *pool, uint32_t mark, polynomial *a);
