/* Internal state of particle sensors: cells, particles, and buffers that are kept from step to step. */
#pragma once

#include "sensors/exact_check.h"
#include "sensors/particles.h"
#include "sensors/partition.h"
#include "sensors/placement.h"
#include "sensors/reach.h"
#include "sensors/renewal.h"

/* ---- near particles of watched parts ------------------------------------------------------------------- */

/* Gathers the near particles of watched parts over several moments and sorts them by pairs of parts, without
 * a table of all pairs of parts. */

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

/* ---- sensors ------------------------------------------------------------------------------------------- */

struct cscd_sensors {
    reference_count references; /* the caller alone */
    cscd_context *context;
    cscd_sensor_options options;
    sensor_partition partition;
    const cscd_mesh *mesh; /* that of the partition */

    /* CELLS: the partition's generation that particles belong to; 0: before the first step */
    uint64_t generation;
    particles particles;
    random_particles random; /* RANDOM */
    uint32_t *before;        /* the vertices of particles before the step, for a step that fails */
    uint32_t before_capacity;

    sensor_reach reach;
    particle_pairs pairs;
    exact_check exact;
    sensor_renewal renewal;
    cscd_renewal *renewals; /* per part */

    uint32_t *cells_a, *cells_b; /* the cells of the pair of parts that is checked */
    uint64_t *cell_checks;       /* per cell: the last check that it took part in */
    uint64_t checks;

    cscd_warning *warnings;
    size_t warning_capacity;
    cscd_sensor_timings timings;
    cscd_sensor_counters counters;
    double *unpacked[2]; /* x0 and x1 of views that are not packed doubles; NULL before the first */
};

/* Writes the warnings of the step's pairs to s->warnings, sorted, and their number to *count; with the exact
 * check done if the options ask for it. */
cscd_status sensor_verdict(cscd_sensors *s, const double *start, const double *end, size_t *count,
                           cscd_sensor_timings *timings, cscd_sensor_counters *counters);
