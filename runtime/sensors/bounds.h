/* The certified mode of particle sensors: parts that provably do not touch in an interval. */
#pragma once

#include "src/mesh/partition.h"

/* Around all that a cell's triangles are, at any moment: about one of its vertices, which moves linearly. */
typedef struct cell_ball {
    double start[3], end[3];
    double radius; /* rounded up */
} cell_ball;

/* Around all that a part's triangles sweep. */
typedef struct part_box {
    double low[3], high[3];
} part_box;

/* Workspace. */
typedef struct sensor_bounds {
    const cscd_mesh *mesh;
    uint64_t generation;             /* of the partition that the lists are of; 0: of none */
    uint32_t *offsets, *corners;     /* of the triangles that cell c answers for, each vertex once */
    uint32_t *homes, *last, *cursor; /* scratch: per triangle its cell, per vertex, per cell */
    uint32_t *middles;               /* per cell: a vertex in its middle, when cells were made */
    bool *unbounded;                 /* per part: it has triangles, but no cell */
    cell_ball *balls;                /* room for one per vertex */
    part_box *boxes;                 /* per part */
} sensor_bounds;

/* Asks for all the memory that it will need. */
cscd_status sensor_bounds_create(const cscd_partition *partition, sensor_bounds *out);
/* Of zeros: does nothing. */
void sensor_bounds_destroy(sensor_bounds *bounds);

/* Balls for one interval about one vertex per cell: its particle's, or any other; NULL: about those in the
 * middle, whose balls are smaller. */
void sensor_bounds_update(sensor_bounds *bounds, const cscd_partition *partition, const double *start,
                          const double *end, const uint32_t *centres);

/* True: no triangle of the one part touches one of the other at any moment of the interval of the last
 * update. part_a != part_b. */
bool sensor_bounds_apart(const sensor_bounds *bounds, const cscd_partition *partition, uint32_t part_a,
                         uint32_t part_b);

/* The same question to the parts' swept boxes, to compare with; of the interval of their own last update. */
void sensor_bounds_update_boxes(sensor_bounds *bounds, const cscd_partition *partition, const double *start,
                                const double *end);
bool sensor_bounds_boxes_apart(const sensor_bounds *bounds, uint32_t part_a, uint32_t part_b);
