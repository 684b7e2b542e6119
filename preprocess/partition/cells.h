/* Cells of parts: near vertices with like normals, connected. */
#pragma once

#include "preprocess/partition/lbg.h"
#include "preprocess/regions/connect.h"
#include "src/mesh/partition.h"

/* Makes cells and keeps them until they are handed over, so that a partition is never half renewed. */
typedef struct cell_maker {
    cscd_partition *partition;
    const double *positions;
    uint32_t *offsets, *neighbours; /* along edges in the same part */
    uint32_t *labels;               /* of vertices: cells, numbered from 0 in each part */
    uint32_t *counts;               /* per part: how many are wanted, and then, how many there are */
    double *distortions;            /* per part */
    double *vectors;
    uint32_t *vector_labels, *order, *candidates;
    lbg_code *codes;
    connect_work connecting;
} cell_maker;

/* Begins with the partition's cells. largest: the most vertices of a part that cells are made for. */
cscd_status cell_maker_create(cscd_partition *partition, const double *positions, uint32_t largest,
                              cell_maker *out);
void cell_maker_free(cell_maker *maker);

/* As many cells as counts says, 1 to the part's vertices; after connecting, counts says how many it is. */
void make_cells(cell_maker *maker, uint32_t part);

/* Writes all cells to the partition. */
void hand_over_cells(const cell_maker *maker);
