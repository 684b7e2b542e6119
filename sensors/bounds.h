/* The certified mode of particle sensors: parts that provably do not touch in an interval. */
#pragma once

#include "sensors/partition.h"

/* A ball about one of a cell's vertices, which moves linearly: it holds the cell's triangles at any
 * moment. */
typedef struct cell_ball {
    double start[3], end[3];
    double radius; /* rounded up */
} cell_ball;

/* The box of everything that a part's triangles sweep. */
typedef struct part_box {
    double low[3], high[3];
} part_box;

/* Workspace, kept from step to step. */
typedef struct sensor_bounds {
    const cscd_mesh *mesh;
    uint32_t part_count;
    uint64_t generation;             /* the generation of the partition that was listed; 0: none yet */
    uint32_t *offsets, *corners;     /* per cell: the corners of its triangles, each vertex once */
    uint32_t *homes, *last, *cursor; /* scratch: the cell per triangle; per vertex; per cell */
    uint32_t *middles;               /* per cell: a vertex in its middle at the time when cells were made */
    bool *unbounded;                 /* per part: it has triangles, but no cell */
    cell_ball *balls;                /* per cell, of which there are at most as many as vertices */
    part_box *boxes;                 /* per part */
} sensor_bounds;

/* Allocates all memory that later updates need. */
cscd_status sensor_bounds_create(const cscd_partition *partition, sensor_bounds *out);
/* A structure of zeros is left as it is. */
void sensor_bounds_destroy(sensor_bounds *bounds);

/* Makes the balls of one interval, each about one vertex of its cell: centres[c], or with NULL the one in the
 * middle, which makes balls smaller. */
void sensor_bounds_update(sensor_bounds *bounds, const cscd_partition *partition, const double *start,
                          const double *end, const uint32_t *centres);

/* Returns true only if no triangle of one part touches one of the other at any moment of the interval of the
 * last update. The parts must be different ones. */
bool sensor_bounds_apart(const sensor_bounds *bounds, const cscd_partition *partition, uint32_t part_a,
                         uint32_t part_b);

/* Asks the same of the swept boxes of the parts, which are updated separately. */
void sensor_bounds_update_boxes(sensor_bounds *bounds, const cscd_partition *partition, const double *start,
                                const double *end);
bool sensor_bounds_boxes_apart(const sensor_bounds *bounds, uint32_t part_a, uint32_t part_b);
