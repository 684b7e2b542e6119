/* The making of a partition: codes of vectors, cells of parts, and the number of cells of a part. */
#pragma once

#include "sensors/partition.h"
#include "src/mesh/plan.h"

/* ---- vector quantization ------------------------------------------------------------------------------- */

/* Vector quantization by splitting (Linde, Buzo and Gray 1980): groups of near vectors and their means. */

enum { LBG_DIMENSIONS = 6, LBG_ROUNDS_MAX = 200 };

/* A group of vectors; its mean is the code that stands for them. */
typedef struct lbg_code {
    double mean[LBG_DIMENSIONS], sum[LBG_DIMENSIONS];
    double distortion; /* the sum of squared distances to the mean */
    uint32_t first, count;
    uint32_t end;     /* where its vectors end in `order` */
    bool changed;     /* it got or lost a vector: its mean must be found again */
    bool moved;       /* its mean has changed: vectors must be compared with it */
    bool indivisible; /* until it changes */
} lbg_code;

/* The vectors, the parameters and the result. */
typedef struct lbg {
    const double *vectors;            /* LBG_DIMENSIONS each */
    uint32_t vector_count, codes_max; /* 1 or more each */
    double epsilon;                   /* another round while the distortion falls by more than this share */
    uint32_t *labels;                 /* out: the code of each vector */
    lbg_code *codes;                  /* out, codes_max */
    uint32_t *order, *candidates;     /* vector_count and codes_max, for its own use */

    /* NULL, or told the number of codes and the mean distortion per dimension (3.10) after every round. */
    void (*observe)(void *user, uint32_t code_count, double distortion);
    void *user;
} lbg;

/* The number of codes, none of them empty: codes_max, or fewer where there are fewer different vectors.
 *
 * From one code on, the code of largest distortion is split, one at a time, so any number of codes will do:
 * in two by the plane through its mean across the direction of its largest variance. That is where the
 * published C +- epsilon C, with a step in that direction instead of C, leads for any small epsilon; C itself
 * is no direction for a shape centred at the origin. Then every vector goes to its nearest code and every
 * code to its vectors' mean (3.7-3.9), until the distortion hardly falls (3.11). A code that runs empty takes
 * half of the code of largest distortion. The smaller number wins every tie. */
uint32_t lbg_run(const lbg *l);

/* ---- cells --------------------------------------------------------------------------------------------- */

/* A graph of all vertices, and workspace to connect the labels of a part. */
typedef struct connect_work {
    const uint32_t *offsets, *neighbours; /* of vertices, in their part only */
    uint32_t *labels;                     /* of vertices, changed */
    uint32_t *pieces;                     /* of vertices */
    uint32_t *queue;                      /* one per vertex of a part, as all below */
    uint32_t *piece_offsets;              /* and one more */
    uint32_t *piece_labels;
    bool *settled;  /* per piece */
    uint32_t *best; /* per label: a piece, a count or a number, by the step */
} connect_work;

/* Makes cells and keeps them until they are all written to the partition, so that it is never half
 * renewed. */
typedef struct cell_maker {
    sensor_partition *partition;
    const double *positions;
    uint32_t largest;               /* the most vertices of a part that cells are made for */
    uint32_t *offsets, *neighbours; /* of vertices, along edges in the same part */
    uint32_t *labels;               /* per vertex: its cell, numbered from 0 in each part */
    uint32_t *counts; /* per part: the number of cells that it shall get, then the number that it got */
    double *vectors;
    uint32_t *vector_labels, *order, *candidates;
    lbg_code *codes;
    connect_work connecting;
} cell_maker;

/* Begins with the partition's present cells. No part that cells are made for has more vertices than
 * `largest`. */
cscd_status cell_maker_create(sensor_partition *partition, const double *positions, uint32_t largest,
                              cell_maker *out);
void cell_maker_free(cell_maker *maker);

/* Divides a part into counts[part] cells, from 1 to the number of its vertices. Connecting them can change
 * the number, which is then in counts[part]. */
void make_cells(cell_maker *maker, uint32_t part);

/* Writes all cells to the partition. */
void hand_over_cells(const cell_maker *maker);

/* ---- numbers of cells ---------------------------------------------------------------------------------- */

/* Takes parts as spheres of their areas: a part gets as many cells as other spheres can touch it at once. */

/* Returns the number of spheres of radius `other` that can touch one of this radius at once, at most `most`
 * and at least 1. For equal spheres (within 1 %) it is 12. For others it is the number of their shadows that
 * fit on the sphere by area, which are circles of half angle asin(other / (radius + other)) seen from its
 * centre; for equal spheres that would be 14. External for its test, which compares it with numbers worked
 * out by hand. */
uint32_t kissing_number(double radius, double other, uint32_t most);

/* Writes the radii of spheres that have the areas of the parts. */
void find_radii(const sensor_partition *partition, const double *positions, double *radii);

/* Counts the cells of each part: the number that the options give; else 1 for each of two convex objects that
 * are all there are, 1 for a part that is not watched, and for others the number of spheres, of the size of
 * the smallest part that is watched with it, that touch it at once. A part has at most as many cells as
 * vertices, and at most the options' cells_max. convex has an element per part. */
cscd_status count_cells(const sensor_partition *partition, const double *radii, const bool *convex,
                        uint32_t *counts);
