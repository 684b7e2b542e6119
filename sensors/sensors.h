/* Internal state of particle sensors: cells, particles, and buffers that are kept from step to step. */
#pragma once

#include "sensors/exact_check.h"
#include "sensors/particles.h"
#include "sensors/partition.h"
#include "sensors/placement.h"
#include "sensors/reach.h"
#include "sensors/renewal.h"
#include "sensors/warnings.h"

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
