/* The potential of the charges of a component at all its collocation points, in time n log n: a treecode with expansions about
 * sources and targets (Greengard, Rokhlin 1987). */
#pragma once

#include "preprocess/treecode/interactions.h"
#include "preprocess/treecode/treecode_kernels.h"

typedef struct treecode {
    cscd_context *context;
    source_tree tree;
    interactions lists;
    expansion_tables tables;
    const treecode_kernels *kernels;
    double *moments, *coefficients; /* of all nodes, HARMONIC_COUNT each */
    size_t *
        exact_begins; /* leaf l has exact_potentials[exact_begins[l] .. exact_begins[l + 1]), see near_field */
    float *exact_potentials;
    size_t exact_count;
} treecode;

/* The system is used as long as the treecode lives. OUT_OF_MEMORY, too, if it takes more bytes than the limit: that depends on
 * how large the triangles are beside their neighbours. */
cscd_status treecode_create(cscd_context *context, const charge_system *system, size_t memory_limit,
                            treecode *out);
void treecode_destroy(treecode *t);

/* Writes the potentials at the collocation points, in the order of the tree, as are the charges. The error of each is at most 1 % of
 * the potential that far charges would have if all were positive; 1e-5 of it is usual. The same bits for any number of threads and on
 * every processor. */
cscd_status treecode_evaluate(treecode *t, const double *charges, double *potentials);
