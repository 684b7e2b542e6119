/* The preconditioner: charges of a leaf's triangles from the potentials there and around, as if nothing else were charged. */
#pragma once

#include "preprocess/treecode/treecode.h"

typedef struct near_blocks {
    const treecode *t;
    size_t *begins; /* leaf l has the block members[begins[l] .. begins[l + 1]), its own sources first */
    size_t *
        row_begins; /* and rows[row_begins[l] ..], the inverse's rows of its own sources by columns of the block */
    uint32_t *members; /* places in the tree's order */
    float *rows;
    size_t member_count, row_count;
} near_blocks;

/* The bytes that the blocks of a treecode take while they are made. */
double near_blocks_bytes(const treecode *t);

/* The treecode is used as long as the blocks live. */
cscd_status near_blocks_create(const treecode *t, near_blocks *out);
void near_blocks_destroy(near_blocks *blocks);

/* Writes charges that have about these potentials; both in the tree's order. */
void near_blocks_apply(const near_blocks *blocks, const double *potentials, double *charges);
