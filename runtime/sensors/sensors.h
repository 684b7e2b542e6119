/* The sensors' inside: particles, what they are measured against, and buffers that live from step to step. */
#pragma once

#include "runtime/sensors/bounds.h"
#include "runtime/sensors/exact_check.h"
#include "runtime/sensors/particle_pairs.h"
#include "runtime/sensors/particles.h"
#include "runtime/sensors/random_particles.h"
#include "runtime/sensors/reach.h"
#include "runtime/sensors/renewal.h"

struct cscd_sensors {
    cscd_context *context;
    const cscd_mesh *mesh;
    cscd_partition *partition;
    cscd_sensor_options options;

    uint64_t generation; /* of the partition that particles are of, with CELLS; 0: before the first step */
    particles particles;
    random_particles random; /* RANDOM */
    uint32_t *before;        /* where particles were before the step: a step that fails puts them back */
    uint32_t before_capacity;

    sensor_reach reach;
    particle_pairs pairs;
    sensor_areas areas;
    sensor_upkeep upkeep;
    sensor_bounds bounds;
    cscd_renewal *renewals; /* per part */

    uint32_t *cells_a, *cells_b; /* of the pair of parts that is checked */
    uint64_t *cell_checks;       /* per cell: the number of the check that it was last put in */
    uint64_t checks;

    cscd_warning *warnings;
    size_t warning_capacity;
    cscd_sensor_timings timings;
    cscd_sensor_counters counters;
};

/* Warnings of the step's pairs, sorted already. *count of them are in s->warnings, with the exact check done
 * where the options ask for it. */
cscd_status sensor_verdict(cscd_sensors *s, const double *start, const double *end, size_t *count,
                           cscd_sensor_timings *timings, cscd_sensor_counters *counters);
