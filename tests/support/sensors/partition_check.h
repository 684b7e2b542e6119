/* Asserts the invariants of every partition, and makes bodies to divide. */
#pragma once

#include "sensors/sensors.h"
#include "tests/support/models/bodies.h"

/* Checks that each vertex with a triangle is in one cell of a part that has most of its triangles, that
 * cells are not empty, are numbered part by part and are connected, and that all lists agree. */
void check_partition(const sensor_partition *partition);

/* Makes sensors and checks their partition; the test fails when they cannot be made. */
cscd_sensors *sensors_of(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                         const cscd_sensor_options *options);

/* Bodies of about 600 triangles stand beside each other as the components of one mesh, scaled; and its
 * sensors. */
typedef struct sensor_row {
    body b;
    cscd_mesh *mesh;
    cscd_sensors *sensors;
} sensor_row;

sensor_row row_of(uint32_t count, const body_kind *kinds, const double *scales,
                  const cscd_sensor_options *options);
void row_free(sensor_row *r);
