/* What long triangles do to targets that are far from their centroids, but not from them: the potentials of two such nodes vary
 * smoothly from triangle to triangle, so few columns of their block give all others (an interpolative decomposition: Cheng, Gimbutas,
 * Martinsson, Rokhlin 2005). Without, every fan of n triangles would have n^2 near pairs. */
#pragma once

#include "preprocess/treecode/interactions.h"

/* numbers[begin ..]: `rank` columns of the targets' potentials, and as many rows of weights, one for each source; with rank 0 the
 * potentials of all sources. Each is of a charge of 1. */
typedef struct rank_block {
    uint32_t target, source; /* nodes */
    uint32_t rank;
    size_t begin;
} rank_block;

/* The blocks whose targets are in one task's subtree. */
typedef struct rank_list {
    rank_block *blocks;
    float *numbers;
    size_t block_count, block_room, number_count, number_room;
} rank_list;

typedef struct rank_blocks {
    cscd_context *context; /* NULL: there is nothing to be freed */
    rank_list lists[TREE_TASKS_MOST];
} rank_blocks;

/* The bytes that the blocks of these interactions will usually take, with what finding them takes. */
double rank_blocks_expected_bytes(const source_tree *tree, const interactions *lists);

/* The bytes that they take. */
double rank_blocks_bytes(const rank_blocks *blocks);

/* Finds the blocks. Where the potentials of one are not smooth it is parted further, and at last all of them are kept. */
cscd_status rank_blocks_create(const source_tree *tree, const interactions *lists, rank_blocks *out);
void rank_blocks_destroy(rank_blocks *blocks);

/* Adds the potentials of a task's blocks; both in the tree's order. The same bits on every processor. */
void rank_blocks_add(const source_tree *tree, const rank_blocks *blocks, uint32_t task, const double *charges,
                     double *potentials);
