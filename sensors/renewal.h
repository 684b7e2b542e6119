/* Tells when particle sensors are due for new cells: areas, edges and concavity against what they were at first. */
#pragma once

#include "sensors/partition.h"

/* The measures of a part, when its cells were made or now. */
typedef struct part_measures {
    double area, estimate; /* each is that of its largest cell */
    double edge_squared;   /* the squared length of the longest edge at its vertices */
    double concave;        /* the share of concave edges in the length of its inner edges */
} part_measures;

/* The cross product of two sides of a triangle, and its length, which is twice the area. */
typedef struct facing {
    double normal[3], length;
} facing;

/* Workspace, kept from step to step. */
typedef struct sensor_renewal {
    const cscd_mesh *mesh;
    uint32_t part_count;
    uint64_t generation;        /* the generation of the partition that `first` belongs to; 0: none yet */
    uint64_t *part_generations; /* per part: the generation of its cells */
    part_measures *first, *now; /* per part */
    double *inner, *concave;    /* per part: lengths of edges */
    double *cell_areas;         /* per cell, of which there are at most as many as vertices */
    facing *facings;            /* per triangle */
    double *volumes;            /* per component: six times the enclosed volume */
    bool *inside_out;           /* per component: it is closed, and its triangles face inwards */
} sensor_renewal;

typedef struct renewal_limits {
    double area_factor;
    double edge_length; /* 0: no limit */
} renewal_limits;

cscd_status sensor_renewal_create(const sensor_partition *partition, sensor_renewal *out);
/* A structure of zeros is left as it is. */
void sensor_renewal_destroy(sensor_renewal *renewal);

/* Measures, before each step, the parts whose cells are new since the last call. Their first estimate is the
 * largest one from any vertex of a cell, or from 64 vertices of a large cell, so that walking particles do
 * not change it much. */
void sensor_renewal_follow(sensor_renewal *renewal, const sensor_partition *partition,
                           const double *positions);

/* Writes for every part the first reason that holds of AREA, CONCAVE and EDGE, and returns how many are not
 * NONE. particles[c] is the vertex of the particle in cell c; with NULL areas are not estimated. Neither this
 * call nor the one above allocates. */
uint32_t sensor_renewal_check(sensor_renewal *renewal, const sensor_partition *partition,
                              const double *positions, const uint32_t *particles,
                              const renewal_limits *limits, cscd_renewal *renewals);

/* Returns the area of the rectangle that four walks from a vertex span within its cell (section 3.6).
 * External for its test, which compares it with walks done by hand. */
double sensor_renewal_estimate(const sensor_partition *partition, const double *positions, uint32_t vertex);
