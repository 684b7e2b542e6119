/* When particle sensors are due for new cells: areas, edges and concavity against what they were at first. */
#pragma once

#include "src/mesh/partition.h"

/* A part's measures: when its cells were made, or now. */
typedef struct part_measures {
    double area, estimate; /* the largest of its cells */
    double edge_squared;   /* of the longest edge at its vertices */
    double concave;        /* share of the concave ones in the length of its inner edges */
} part_measures;

/* Of a triangle: the cross product of two sides, and its length, twice the area. */
typedef struct facing {
    double normal[3], length;
} facing;

/* Workspace. */
typedef struct sensor_upkeep {
    const cscd_mesh *mesh;
    uint64_t generation;        /* of the partition that `first` is of; 0: of none */
    uint64_t *part_generations; /* of each part's cells */
    part_measures *first, *now; /* per part */
    double *inner, *concave;    /* per part: lengths of edges */
    double *cell_areas;         /* room for one per vertex */
    facing *facings;            /* per triangle */
    bool *inside_out;           /* per component: closed, and its triangles face inwards */
} sensor_upkeep;

typedef struct upkeep_limits {
    double area_factor;
    double edge_length; /* 0: any */
} upkeep_limits;

cscd_status sensor_upkeep_create(const cscd_partition *partition, sensor_upkeep *out);
/* Of zeros: does nothing. */
void sensor_upkeep_destroy(sensor_upkeep *upkeep);

/* Before each step: takes the measure of parts whose cells are new since the last call. Their first estimate
 * is the largest from any vertex of a cell, or of a large cell any of 64, so that particles that walk about
 * do not change it much. */
void sensor_upkeep_follow(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions);

/* particles: the vertex of each cell's; NULL: areas are not estimated. Writes a reason for every part, the
 * first that holds of AREA, CONCAVE and EDGE, and returns how many of them are not NONE. Allocates nothing,
 * as the call above. */
uint32_t sensor_upkeep_check(sensor_upkeep *upkeep, const cscd_partition *partition, const double *positions,
                             const uint32_t *particles, const upkeep_limits *limits, cscd_renewal *renewals);

/* The area of the rectangle that walks in four directions span from a vertex within its cell (section 3.6).
 */
double sensor_upkeep_estimate(const cscd_partition *partition, const double *positions, uint32_t vertex);
