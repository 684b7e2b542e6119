/* Divides parts into cells: connected groups of near vertices with similar normals. */
#pragma once

#include "preprocess/partition/connect.h"
#include "preprocess/partition/lbg.h"
#include "src/mesh/partition.h"

/* Makes cells and keeps them until they are all written to the partition, so that it is never half
 * renewed. */
typedef struct cell_maker {
    cscd_partition *partition;
    const double *positions;
    uint32_t largest;               /* the most vertices of a part that cells are made for */
    uint32_t *offsets, *neighbours; /* of vertices, along edges in the same part */
    uint32_t *labels;               /* per vertex: its cell, numbered from 0 in each part */
    uint32_t *counts;    /* per part: the number of cells that it shall get, then the number that it got */
    double *distortions; /* per part */
    double *vectors;
    uint32_t *vector_labels, *order, *candidates;
    lbg_code *codes;
    connect_work connecting;
} cell_maker;

/* Begins with the partition's present cells. No part that cells are made for has more vertices than
 * `largest`. */
cscd_status cell_maker_create(cscd_partition *partition, const double *positions, uint32_t largest,
                              cell_maker *out);
void cell_maker_free(cell_maker *maker);

/* Divides a part into counts[part] cells, from 1 to the number of its vertices. Connecting them can change
 * the number, which is then in counts[part]. */
void make_cells(cell_maker *maker, uint32_t part);

/* Writes all cells to the partition. */
void hand_over_cells(const cell_maker *maker);
