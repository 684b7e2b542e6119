/* Potentials of far charges by Taylor expansions of 1 / r in Cartesian coordinates (Greengard, Rokhlin 1987; in this form
 * Duan, Krasny 2001). A multi-index is a triple of exponents; its degree is their sum.
 *
 * A source's moment for multi-index a is the sum of q (c - y)^a / a! over its charges q at y, about its centre c. With D_g, the
 * derivative g of 1 / r at the vector from the centre of a source to that of a target, the target's coefficient for b is the
 * sum of moment(a) D_(a+b), and the potential at x the sum of coefficient(b) (x - c)^b / b!. 1 / r is harmonic, so
 * D_(g+2z) = -D_(g+2x) - D_(g+2y): moments and coefficients with a z exponent of 2 or more follow from the others, and only
 * those with 0 or 1, the harmonic ones, are kept. */
#pragma once

#include <stdint.h>

enum {
    EXPANSION_ORDER = 6, /* the greatest degree */
    FULL_COUNT = 84,     /* multi-indices of that degree and below */
    HARMONIC_COUNT = 49, /* of these the harmonic ones */
    SHIFT_COUNT = 714,   /* pairs of a harmonic and any multi-index whose sum is one */
    PRODUCT_COUNT =
        1092 /* pairs of harmonic ones whose sum is one of degree 0, 1, .. or 6: 1 + 7 + .. + 532 */
};

/* Multi-index i is its parent and 1 more along an axis. */
typedef struct index_step {
    uint8_t parent, axis;
    double factor; /* 1 / its exponent along the axis */
} index_step;

/* D_i as a combination of those of lower degree: of first[k] times the vector's coordinate k, and of second[k]. A factor of 0
 * is of an index that does not exist. */
typedef struct tensor_step {
    uint8_t first[3], second[2];
    double first_factors[3], second_factors[2];
} tensor_step;

/* out = the sum of two multi-indices, both named by their place in the list that they are from. */
typedef struct index_sum {
    uint8_t harmonic, other, out;
} index_sum;

typedef struct expansion_tables {
    uint8_t full_end[EXPANSION_ORDER + 1];     /* how many multi-indices have at most this degree */
    uint8_t harmonic_end[EXPANSION_ORDER + 1]; /* and how many harmonic ones */
    uint8_t exponents[FULL_COUNT][3];          /* ordered by degree, then by z */
    uint8_t harmonic[HARMONIC_COUNT];          /* their places among all */
    uint8_t folds[FULL_COUNT]
                 [2]; /* of those with z of 2 or more: the two with 2 less along z and 2 more along x, y */
    index_step steps[FULL_COUNT];
    tensor_step tensor_steps[FULL_COUNT];
    index_sum shifts[SHIFT_COUNT];
    /* Coefficient l of an expansion of order p takes products[p][l] to products[p][l + 1] - 1. */
    uint16_t products[EXPANSION_ORDER + 1][HARMONIC_COUNT + 1];
    uint8_t product_moments[PRODUCT_COUNT], product_tensors[PRODUCT_COUNT];
} expansion_tables;

void expansion_tables_set(expansion_tables *tables);

/* Adds the moments of a charge at a place, given from the centre; all FULL_COUNT of them. */
void expansion_add_charge(const expansion_tables *tables, const double place[3], double charge, double *full);

/* Adds all moments of harmonic ones about another centre, from which theirs is at `place`. */
void expansion_add_moments(const expansion_tables *tables, const double place[3], const double *moments,
                           double *full);

/* Expresses all moments by the harmonic ones; destroys the others. */
void expansion_fold(const expansion_tables *tables, double *full, double *harmonic);

/* Adds coefficients about another centre, at `place` from the present one. */
void expansion_add_coefficients(const expansion_tables *tables, const double place[3],
                                const double *coefficients, double *shifted);

/* Finds all coefficients from the harmonic ones. */
void expansion_unfold(const expansion_tables *tables, const double *harmonic, double *full);

/* The potential at a place, given from the centre, by all coefficients. */
double expansion_potential(const expansion_tables *tables, const double place[3], const double *full);
