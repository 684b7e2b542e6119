/* The kernels of the treecode. */
#pragma once

#include "preprocess/treecode/expansion.h"
#include "preprocess/treecode/interactions.h"
#include "src/core/kernels.h"

/* A node's far items; moments of all nodes, HARMONIC_COUNT each. */
typedef struct far_field {
    const expansion_tables *tables;
    const source_node *nodes;
    const double *moments;
    const far_item *items;
    size_t item_count;
} far_field;

enum { LEAF_VECTORS = SOURCES_PER_LEAF / LANES };

/* A leaf's targets, from its center, and what is near them. Those that fill up the last vector repeat a target. */
typedef struct near_field {
    float x[SOURCES_PER_LEAF], y[SOURCES_PER_LEAF], z[SOURCES_PER_LEAF];
    uint32_t vector_count;
    const double *center;
    const tree_source *sources;
    const double *charges; /* of all sources */
    const uint32_t *exact, *points;
    size_t exact_count, point_count;
    const float *potentials; /* of a charge of 1 on an exact source: vector_count * LANES of each */
} near_field;

typedef struct treecode_kernels {
    /* Adds the potential of the far items, as coefficients about the center of a node. */
    void (*add_far_field)(const far_field *field, const double center[3],
                          double coefficients[HARMONIC_COUNT]);

    /* Writes the potential of what is near. */
    void (*near_potential)(const near_field *field, double potentials[SOURCES_PER_LEAF]);
} treecode_kernels;

DECLARE_KERNELS(treecode_kernels);
