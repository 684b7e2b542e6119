/* Gathers the near particles of watched parts over several moments and sorts them by pairs of parts, without
 * a table of all pairs of parts. */
#pragma once

#include "sensors/particles.h"
#include "sensors/reach.h"

/* Two particles of watched parts that are nearer than their mu. Part a is the one with the smaller number. */
typedef struct near_particles {
    uint32_t part_a, part_b, cell_a, cell_b;
    uint32_t vertex_a, vertex_b;
    double distance;
    uint32_t moment; /* 0: the start, 1: the end */
} near_particles;

typedef struct particle_pairs {
    near_particles *items, *scratch;
    size_t count, capacity;
} particle_pairs;

void particle_pairs_free(cscd_context *context, particle_pairs *pairs);

/* Adds the pairs of particles that are near each other at positions x. *closest is the smallest distance of
 * two particles that attract each other, within the largest mu; INFINITY if there is none. Builds the grid of
 * the particles again. */
cscd_status particle_pairs_gather(particle_pairs *pairs, particles *p, const sensor_partition *partition,
                                  const sensor_reach *reach, const double *x, uint32_t moment,
                                  double *closest);

/* Sorts by (part_a, part_b, distance, moment, vertices). */
void particle_pairs_sort(particle_pairs *pairs);
