/* The exact check of particle sensors: do the areas of cells of two parts touch, and when first? */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"
#include "runtime/narrow_phase/swept_box.h"
#include "src/mesh/partition.h"

/* A feature to sweep over, sorted by the low side of its box. */
typedef struct area_item {
    uint64_t key; /* orders as that number does */
    uint32_t feature, box;
} area_item;

/* Features of one kind and one side that reach where both sides do. */
typedef struct area_items {
    area_item *items, *scratch;
    swept_box *boxes;
    uint32_t count, capacity;
} area_items;

typedef struct area_list {
    uint8_t *sides; /* per feature of the mesh, bits: of which sides it is; 0 between checks */
    uint32_t *members;
    uint32_t count;
} area_list;

/* Workspace, kept from one check to the next. */
typedef struct sensor_areas {
    const cscd_mesh *mesh;
    area_list vertices, edges, triangles;
    area_items first, second;
    contact_lane *lane;
} sensor_areas;

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

cscd_status sensor_areas_create(const cscd_mesh *mesh, sensor_areas *out);
/* Of zeros: does nothing. */
void sensor_areas_destroy(sensor_areas *areas);

/* A side's features are those of all triangles with a vertex in one of its cells. Every vertex and face, and
 * every two edges, one of each side, that share no vertex and whose swept boxes meet, are tested as by the
 * detector, once. */
cscd_status sensor_areas_check(sensor_areas *areas, const cscd_partition *partition, const area_query *query,
                               area_verdict *out);
