/* Factorisation of one front after the other. */
#pragma once

#include "runtime/untangle/front_tree.h"

/* A factorisation U'U of a matrix whose tree of fronts stands beside it. U has the inverses of its diagonal in place of that. */
typedef struct front_factors {
    double *factors;  /* tree->factor_size: the rows of pivots, from their diagonals on */
    double *updates;  /* tree->update_size: a stack of what fronts leave to their parents */
    size_t height;    /* of the stack */
    double *scratch;  /* 3 numbers for each row of the largest front */
    uint32_t *locals; /* 2 for each row of the matrix */
    size_t replaced;  /* pivots */
} front_factors;

/* Fronts are factorised in the order of their numbers, each when its rows of pivots have what the matrix has there, and zeros. */
void front_factors_begin(front_factors *f);
void front_factors_add(front_factors *f, const cscd_context *context, const front_tree *tree, uint32_t front);

/* x: 3 numbers a place, the right side and then the solution. */
void front_factors_solve(const front_factors *f, const front_tree *tree, double *x);
