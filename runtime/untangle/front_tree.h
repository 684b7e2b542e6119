/* What elimination does to a pattern: a tree of dense matrices, the fronts, each of which eliminates some rows and leaves an update
 * to its parent (Duff and Reid 1983). */
#pragma once

#include "src/core/context.h"

enum { NO_FRONT = UINT32_MAX };

/* Its rows are pivots, which have consecutive places in the order of elimination, and later rows, whose places a list has. Each row is
 * `unit` rows of numbers: 3, or 1 where all blocks so far are numbers times the identity. */
typedef struct matrix_front {
    uint32_t first, pivot_count, row_count;
    uint32_t parent, descendants; /* NO_FRONT; the descendants have the numbers before it */
    uint32_t unit;
    size_t list;                  /* of the row_count - pivot_count later rows */
    size_t factor, stride;        /* where its unit * pivot_count rows of `stride` numbers begin */
    size_t update, update_stride; /* where what it leaves lies in the stack, a square */
} matrix_front;

/* A pair of rows that has a block. */
typedef struct block_slot {
    uint32_t row, column; /* row <= column */
    bool is_scalar;       /* all terms of it are numbers times the identity */
} block_slot;

/* Fronts are in an order in which children come before their parents, and descendants directly before. */
typedef struct front_tree {
    uint32_t row_count, front_count;
    uint32_t *places;   /* of rows in the order of elimination */
    uint32_t *front_of; /* of places */
    matrix_front *fronts;
    uint32_t *lists;
    size_t factor_size, update_size; /* numbers; the latter as much as the stack ever holds */
    uint32_t largest;                /* rows of a front, at most */
} front_tree;

void front_tree_free(cscd_context *context, front_tree *tree);

/* Orders the rows and makes the tree of a pattern without repeated slots; the old tree is freed. CSCD_OUT_OF_MEMORY, or
 * CSCD_CANCELLED: there is no tree. */
cscd_status front_tree_make(cscd_context *context, uint32_t row_count, const block_slot *slots,
                            size_t slot_count, front_tree *out);

/* The place of a row within a front that has it. */
uint32_t front_tree_find(const front_tree *tree, const matrix_front *front, uint32_t place);

/* The numbers that follow in memory of aligned rows are in groups of this size. */
enum { FRONT_ALIGNMENT = 8 };

static inline size_t front_align(size_t count) {
    return (count + FRONT_ALIGNMENT - 1) / FRONT_ALIGNMENT * FRONT_ALIGNMENT;
}
