/* Internal state of particle sensors: particles, bounds, and buffers that are kept from step to step. */
#pragma once

#include "sensors/bounds.h"
#include "sensors/exact_check.h"
#include "sensors/particle_pairs.h"
#include "sensors/particles.h"
#include "sensors/random_particles.h"
#include "sensors/reach.h"
#include "sensors/renewal.h"

struct cscd_sensors {
    reference_count references; /* the caller alone */
    cscd_context *context;
    cscd_partition *partition; /* held, and with it its mesh: */
    const cscd_mesh *mesh;
    cscd_sensor_options options;

    uint64_t
        generation; /* CELLS: the partition's generation that particles belong to; 0: before the first step */
    particles particles;
    random_particles random; /* RANDOM */
    uint32_t *before;        /* the vertices of particles before the step, for a step that fails */
    uint32_t before_capacity;

    sensor_reach reach;
    particle_pairs pairs;
    exact_check exact;
    sensor_renewal renewal;
    sensor_bounds bounds;
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
