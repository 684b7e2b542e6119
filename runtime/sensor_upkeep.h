/* When particle sensors are due for new cells: areas, edges and concavity against what they were at first. */
#ifndef CSCD_SENSOR_UPKEEP_H
#define CSCD_SENSOR_UPKEEP_H

#include "src/partition.h"

/* What a part was when its cells were made. */
typedef struct part_at_first {
    uint64_t generation;   /* of these cells; 0: not yet looked at */
    double area, estimate; /* the largest of its cells; estimates: wherever in its cell a particle may be */
    double concave;        /* share of its inner edges' length */
} part_at_first;

typedef struct sensor_upkeep {
    cscd_context *context;
    const cscd_mesh *mesh;
    part_at_first *parts;
    double *cell_areas;       /* per cell, as many as there are vertices */
    double *concave, *length; /* per part: of its inner edges */
    double *longest;          /* per part: squared, of the edges at its vertices */
    bool *inside_out;         /* per component: closed, and its triangles face inwards */
} sensor_upkeep;

typedef struct upkeep_limits {
    double area_factor;
    double edge_length; /* 0: any */
} upkeep_limits;

cscd_status sensor_upkeep_create(const cscd_partition *partition, sensor_upkeep *out);
/* Of zeros: does nothing. */
void sensor_upkeep_destroy(sensor_upkeep *upkeep);

/* Takes the measure of parts whose cells are new since the last call, if there are any: before the first step
 * of these cells. Allocates nothing. */
void sensor_upkeep_follow(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions);

/* After sensor_upkeep_follow. particles: the vertex of each cell's; NULL: areas are not estimated. Writes a
 * reason for every part, the first of several in their order, and returns how many are not NONE. */
uint32_t sensor_upkeep_check(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions,
                             const uint32_t *particles, const upkeep_limits *limits, cscd_renewal *renewals);

/* The area of the rectangle that walks in four directions span from a vertex of a cell (3.19-3.22). */
double sensor_upkeep_estimate(const cscd_partition *partition, const double *positions, uint32_t vertex);

#endif
