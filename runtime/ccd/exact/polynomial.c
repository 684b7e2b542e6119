/* Polynomials of degree 3 at most with integer coefficients. */
#include "runtime/ccd/exact/polynomial.h"

#include <assert.h>

static void find_degree(polynomial *a) {
    a->degree = POLYNOMIAL_DEGREE_MAX;
    while (a->degree >= 0 && a->c[a->degree].size == 0) a->degree--;
}

polynomial polynomial_zero(void) {
    return (polynomial){.degree = -1};
}

polynomial polynomial_linear(integer c0, integer c1) {
    polynomial out = {.c = {c0, c1}};
    find_degree(&out);
    return out;
}

polynomial polynomial_add(integer_pool *pool, const polynomial *a, const polynomial *b) {
    polynomial out;
    for (int i = 0; i <= POLYNOMIAL_DEGREE_MAX; i++) out.c[i] = integer_add(pool, a->c[i], b->c[i]);
    find_degree(&out);
    return out;
}

polynomial polynomial_negate(const polynomial *a) {
    polynomial out = {.degree = a->degree};
    for (int i = 0; i <= POLYNOMIAL_DEGREE_MAX; i++) out.c[i] = integer_negate(a->c[i]);
    return out;
}

polynomial polynomial_subtract(integer_pool *pool, const polynomial *a, const polynomial *b) {
    polynomial negated = polynomial_negate(b);
    return polynomial_add(pool, a, &negated);
}

polynomial polynomial_multiply(integer_pool *pool, const polynomial *a, const polynomial *b) {
    polynomial out = polynomial_zero();
    assert(a->degree < 0 || b->degree < 0 || a->degree + b->degree <= POLYNOMIAL_DEGREE_MAX);
    uint32_t mark = pool->used;
    for (int i = 0; i <= a->degree; i++) {
        for (int j = 0; j <= b->degree; j++) {
            integer product = integer_multiply(pool, a->c[i], b->c[j]);
            out.c[i + j] = integer_add(pool, out.c[i + j], product);
        }
    }
    find_degree(&out);
    polynomial_keep(pool, mark, &out);
    return out;
}

polynomial polynomial_remainder(integer_pool *pool, const polynomial *a, const polynomial *b) {
    polynomial out = *a;
    uint32_t mark = pool->used;
    while (out.degree >= b->degree) {
        integer leading = out.c[out.degree];
        int shift = out.degree - b->degree;
        for (int i = 0; i < out.degree; i++) {
            out.c[i] = integer_multiply(pool, out.c[i], b->c[b->degree]);
            if (i >= shift)
                out.c[i] = integer_subtract(pool, out.c[i], integer_multiply(pool, leading, b->c[i - shift]));
        }
        out.c[out.degree] = (integer){0, out.c[out.degree].limbs};
        find_degree(&out);
    }
    polynomial_keep(pool, mark, &out);
    return out;
}

/* The Bernstein coefficients for degree 2 are c0, c0 + c1 / 2 and c0 + c1 + c2. */
int polynomial_sign_on_interval(integer_pool *pool, const polynomial *a) {
    if (a->degree < 0 || a->degree > 2) return 0;
    uint32_t mark = pool->used;
    integer sum = integer_add(pool, a->c[0], a->c[1]);
    int start = integer_sign(a->c[0]), end = integer_sign(integer_add(pool, sum, a->c[2]));
    int middle = a->degree < 2 ? start : integer_sign(integer_add(pool, sum, a->c[0]));
    pool->used = mark;
    return start == middle && middle == end ? start : 0;
}

void polynomial_keep(integer_pool *pool, uint32_t mark, polynomial *a) {
    integer_pool_keep(pool, mark, a->c, POLYNOMIAL_DEGREE_MAX + 1);
}
