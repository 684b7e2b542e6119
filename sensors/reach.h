/* The distance mu below which particles give a warning, and the distance R_eff within which they feel each
 * other. */
#pragma once

#include "sensors/partition.h"

typedef struct part_reach {
    double longest_edge;    /* of triangles with a corner in the part, at the start or at the end */
    double low[3], high[3]; /* the box of its vertices' displacements */
} part_reach;

typedef struct sensor_reach {
    part_reach *parts;
    double mu_given;       /* 0: by the parts */
    double mu_most;        /* the largest mu of all pairs of parts */
    double radius;         /* R_eff */
    double longest_edge;   /* the longest one, at the start or at the end */
    double longest_inside; /* the same for edges with both ends in one cell */
    double typical_edge;   /* the root mean square of the triangles' sides at the start */
} sensor_reach;

cscd_status sensor_reach_create(const sensor_partition *partition, double mu_given, sensor_reach *reach);
void sensor_reach_free(cscd_context *context, sensor_reach *reach);

/* The sets of vertices that single particles walk on, cells or objects: vertices[offsets[i] .. offsets[i +
 * 1]). */
typedef struct walk_areas {
    const uint32_t *offsets, *vertices;
    uint32_t count;
} walk_areas;

/* Measures the interval from x0 to x1. radius_given is R_eff, or 0 for the automatic one. */
void sensor_reach_measure(sensor_reach *reach, const sensor_partition *partition, const walk_areas *areas,
                          const double *x0, const double *x1, double radius_given);

/* The collision distance of two parts. */
double sensor_reach_mu(const sensor_reach *reach, uint32_t part_a, uint32_t part_b);
