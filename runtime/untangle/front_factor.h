/* Factorisation of one front after the other. */
#pragma once

#include "runtime/untangle/front_tree.h"

/* A factorisation U'U of a matrix whose pivots have a tree of fronts. U has the inverses of its diagonal in place of that. */
typedef struct front_factors {
    const front_tree *tree;
    double
        *factors; /* tree->factor_size: at first the rows of the matrix, from their diagonals on, and zeros */
    double *updates;  /* tree->update_size: a stack of what fronts leave to their parents */
    double *scratch;  /* 3 numbers for each row of the largest front */
    uint32_t *locals; /* 2 for each row of the matrix */
    size_t replaced;  /* pivots */
} front_factors;

/* Returns CSCD_OK or CSCD_CANCELLED. */
cscd_status front_factors_make(cscd_context *context, front_factors *f);

/* x: 3 numbers a place, the right side and then the solution. */
void front_factors_solve(const front_factors *f, double *x);
