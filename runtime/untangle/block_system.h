/* Sparse systems of symmetric matrices whose entries are blocks of 3 x 3 numbers: for each vertex a row. */
#pragma once

#include "runtime/untangle/front_factor.h"
#include "src/core/context.h"

/* A term that is added to the matrix, at row <= column. */
typedef struct block_entry {
    uint32_t row, column;
    uint64_t
        place; /* of its first number among the values, times 2, and 1 more for a number times the identity */
} block_entry;

/* Where a term goes. */
typedef struct block_target {
    size_t place;    /* among the rows of pivots */
    uint64_t source; /* the entry's place */
    uint32_t stride;
    bool is_transposed, is_block; /* is_block: else one number stands for three */
} block_target;

/* A matrix and its factors. It begins as {.context = context}; the memory of one matrix serves the next.
 *
 *     block_system s = {.context = context};
 *     if (!block_system_begin(&s, rows) || !block_system_reserve(&s, terms)) ...
 *     block_system_add_scalar(&s, i, j, weight);
 *     if (block_system_factor(&s) != CSCD_OK) ...
 *     block_system_solve(&s, x);
 *     block_system_free(&s);
 */
typedef struct block_system {
    cscd_context *context;
    uint32_t row_count;
    size_t replaced; /* pivots of the last factorisation, of 3 row_count, that were not positive */

    block_entry *entries, *last_entries; /* now, and those that the tree of fronts was made for */
    size_t entry_count, entry_capacity, last_count, last_capacity;
    double *values;
    size_t value_count, value_capacity;

    front_tree tree;
    block_target *targets; /* of entries, by front, and then in the order of the entries */
    size_t *target_begins; /* of fronts */
    size_t target_capacity;
    front_factors factors;
    size_t factor_capacity, update_capacity, row_capacity, begin_capacity;
    double *ordered; /* a right side in the order of elimination */
    bool has_tree;
} block_system;

void block_system_free(block_system *s);

/* Forgets all entries. False: no memory. */
bool block_system_begin(block_system *s, uint32_t row_count);

/* Makes room for this number of entries more. False: no memory; the entries so far are still there. */
bool block_system_reserve(block_system *s, size_t entries);

/* Adds w times the identity at (i, j), and where i != j at (j, i) too. */
void block_system_add_scalar(block_system *s, uint32_t i, uint32_t j, double w);

/* Adds a block, row by row, at (i, j), and where i != j its transpose at (j, i). Where i = j the block is symmetric. */
void block_system_add_block(block_system *s, uint32_t i, uint32_t j, const double block[9]);

/* Sums the entries in the order in which they were added, orders the rows, and factorises. CSCD_OUT_OF_MEMORY, or CSCD_CANCELLED
 * after cscd_context_cancel; then there are no factors, and the entries may be factorised again. If the entries have the places
 * of the last ones, in the same order, the order of the rows and the tree are kept; this changes no bit.
 *
 * All entries are finite. The factors are those of a positive definite matrix in any case: of this one, or where that is not
 * definite, or nearly so that rounding decides, of the sum of it and a diagonal matrix that is not negative. Then pivots have been
 * replaced. The solution x for a right side b has b'x > 0, so for b = -gradient it is a descent direction. */
cscd_status block_system_factor(block_system *s);

/* x: 3 numbers a row, the right side before and the solution afterwards. May be called any number of times after
 * block_system_factor, by one thread at a time. */
void block_system_solve(const block_system *s, double *x);
