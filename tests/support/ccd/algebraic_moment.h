/* Moments of [0,1] at which an integer polynomial in t vanishes: rational, or algebraic of degree 2 and more.
 */
#pragma once

#include <arb.h>
#include <flint/fmpz_poly.h>
#include <stdbool.h>

enum { MOMENT_MAX = 24 };

/* The only root in [0,1] of a linear factor, num / den; or the only one of an irreducible factor of higher
 * degree in ((num, num + 1) / 2^depth), where local(x) = 2^(depth degree) factor((num + x) / 2^depth). */
typedef struct algebraic_moment {
    fmpz_poly_t factor, local;
    fmpz_t num, den;
    slong depth;
    arb_t root;
} algebraic_moment;

typedef struct moment_list {
    algebraic_moment items[MOMENT_MAX];
    slong count;
} moment_list;

void moments_init(moment_list *list);
void moments_clear(moment_list *list);

void moments_add_rational(moment_list *list, slong num, slong den);

/* All roots of p in [0,1], each once; p is not 0. */
void moments_add_roots(moment_list *list, const fmpz_poly_struct *p);

bool moment_is_rational(const algebraic_moment *m);

/* Exact: -1, 0, 1. */
int moment_sign(algebraic_moment *m, const fmpz_poly_struct *p);

/* Adjacent doubles about it, or twice the moment itself. */
void moment_bounds(algebraic_moment *m, double *low, double *high);
