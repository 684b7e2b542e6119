/* The exact check of particle sensors: do the areas of the cells of two parts touch, and when do they
 * first? */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"
#include "sensors/partition.h"

/* A feature to sweep over, sorted by the low side of its box. */
typedef struct area_item {
    uint64_t key; /* in the order of the low sides */
    uint32_t feature, box;
} area_item;

/* The features of one kind and one side that reach into the common box of both sides. */
typedef struct area_items {
    area_item *items, *scratch;
    swept_box *boxes;
    uint32_t count, capacity;
} area_items;

typedef struct area_list {
    uint8_t *sides; /* per feature of the mesh, a bit per side that it belongs to; 0 between checks */
    uint32_t *members;
    uint32_t count;
} area_list;

/* Workspace, kept from one check to the next. */
typedef struct exact_check {
    const cscd_mesh *mesh;
    area_list vertices, edges, triangles;
    area_items first, second;
    contact_worker *worker;
} exact_check;

/* Cells of two different parts, without repetition, in any order. */
typedef struct area_query {
    const double *start, *end;
    const uint32_t *cells_a, *cells_b;
    uint32_t count_a, count_b;
} area_query;

typedef struct area_verdict {
    bool contact;
    double toi; /* the earliest; 0 without */
    uint64_t tests;
} area_verdict;

cscd_status exact_check_create(const cscd_mesh *mesh, exact_check *out);
/* A structure of zeros is left as it is. */
void exact_check_destroy(exact_check *check);

/* The features of a side are those of all triangles with a vertex in one of its cells. Every pair of a vertex
 * and a face, or of two edges, with one feature of each side, no shared vertex and overlapping swept boxes is
 * tested once, as the detector tests it. */
cscd_status exact_check_run(exact_check *check, const sensor_partition *partition, const area_query *query,
                            area_verdict *out);
