/* The exact check of particle sensors: do the areas of cells of two parts touch, and when first? */
#ifndef CSCD_SENSOR_AREAS_H
#define CSCD_SENSOR_AREAS_H

#include "runtime/narrow_phase.h"
#include "src/partition.h"

/* A feature's swept box, as an interval along the axis of the sweep. */
typedef struct area_item {
    uint64_t key; /* orders by low */
    uint32_t feature, box;
} area_item;

/* Vertices, edges or triangles of one side, sorted for the sweep. */
typedef struct area_items {
    area_item *items;
    swept_box *boxes;
    uint32_t count;
} area_items;

/* Workspace; what it asks for when it is created is enough for every check but one with more contacts than
 * any before it. */
typedef struct sensor_areas {
    cscd_context *context;
    const cscd_mesh *mesh;
    uint8_t *vertex_sides, *edge_sides, *triangle_sides; /* bits: which sides a feature is of; 0 between */
    uint32_t *vertices, *edges, *triangles;              /* those with a side */
    uint32_t vertex_count, edge_count, triangle_count;
    area_items first, second;
    area_item *scratch;
    contact_lane *lane;
} sensor_areas;

typedef struct area_verdict {
    bool contact;
    double toi; /* the earliest; 0 without */
    uint64_t tests;
} area_verdict;

/* Pairs of cells, any number on either side and in any order; a side may also be empty. */
typedef struct area_query {
    const double *start, *end;
    const uint32_t *cells_a, *cells_b;
    uint32_t count_a, count_b;
} area_query;

cscd_status sensor_areas_create(const cscd_mesh *mesh, sensor_areas *out);
/* Of zeros: does nothing. */
void sensor_areas_destroy(sensor_areas *areas);

/* A side's features are those of the triangles with a vertex in one of its cells. Every pair of a vertex and
 * a face, and of two edges, one of each side, that share no vertex, is tested as by the detector, once. */
cscd_status sensor_areas_check(sensor_areas *areas, const cscd_partition *partition, const area_query *query,
                               area_verdict *out);

#endif
