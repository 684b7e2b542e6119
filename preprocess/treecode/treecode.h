/* The potential of the charges of a component at all its collocation points, in time n log n: a treecode with expansions about
 * sources and targets (Greengard, Rokhlin 1987). */
#pragma once

#include "preprocess/treecode/rank_blocks.h"
#include "preprocess/treecode/treecode_kernels.h"

typedef struct treecode {
    cscd_context *context;
    source_tree tree;
    interactions lists;
    rank_blocks ranks; /* made by treecode_fill */
    expansion_tables tables;
    const treecode_kernels *kernels;
    double *moments, *coefficients; /* of all nodes, HARMONIC_COUNT each */
    size_t *
        exact_begins; /* leaf l has exact_potentials[exact_begins[l] .. exact_begins[l + 1]), see near_field */
    float *exact_potentials;
    size_t exact_count;
} treecode;

/* Makes the tree and its lists. The system is used as long as the treecode lives. */
cscd_status treecode_create(cscd_context *context, const charge_system *system, treecode *out);
void treecode_destroy(treecode *t);

/* The bytes that it takes once it is filled: that depends on how large the triangles are beside their neighbours. */
double treecode_bytes(const treecode *t);

/* Finds the potentials of sources that are near, which is done once, before all evaluations. */
cscd_status treecode_fill(treecode *t);

/* Writes the potentials at the collocation points, in the order of the tree, as are the charges. The error of each is at most 1 % of
 * the potential that far charges would have if all were positive; 1e-5 of it is usual. The same bits for any number of threads and on
 * every processor. */
cscd_status treecode_evaluate(treecode *t, const double *charges, double *potentials);
