/* A context, a mesh, a plan and sensors for a scene; partitions made by hand, and the invariants of every partition. */
#pragma once

#include "cscd/cscd.h"
#include "cscd/sensors.h"
#include "sensors/partition.h"
#include "sensors/sensors.h"
#include "tests/support/models/bodies.h"
#include "tests/support/scenes.h"

/* Any failure to make a rig fails the test. */

/* Calls with packed doubles. The context is that of the mesh. */
cscd_status sensors_create_packed(const cscd_mesh *mesh, const cscd_plan *plan, const double *positions,
                                  const cscd_sensor_options *options, cscd_sensors **out);
cscd_status sensors_renew_packed(cscd_sensors *sensors, const double *positions, uint32_t part);
cscd_status sensors_step_packed(cscd_sensors *sensors, const double *x0, const double *x1,
                                cscd_warnings *out);

typedef struct sensor_setup {
    uint32_t regions;                   /* regions of a plan by k-means; 0: no plan */
    const cscd_sensor_options *sensors; /* NULL: the defaults */
} sensor_setup;

typedef struct sensor_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_sensors *sensors;
} sensor_rig;

/* Makes a rig with cells at x0. setup: NULL for all defaults. */
sensor_rig sensor_rig_create(const scene *s, const sensor_setup *setup);
void sensor_rig_destroy(sensor_rig *r);
cscd_warnings sensor_rig_step(const sensor_rig *r, const double *start, const double *end);

/* Returns the first warning of two objects, or NULL if there is none; object_a < object_b. */
const cscd_warning *find_warning(const cscd_warnings *warnings, uint32_t object_a, uint32_t object_b);

/* Returns the warning with the earliest contact of two objects, or NULL if there is none. */
const cscd_warning *find_contact(const cscd_warnings *warnings, uint32_t object_a, uint32_t object_b);

/* Adds a closed tube along a path in a plane z = const: rings of `segments` vertices around its points, and a
 * vertex on each of its ends. */
void scene_add_tube(scene *s, const double (*path)[3], int count, double radius, int segments);

/* Adds a tube along corners; its sides are cut into steps of about this length. */
void scene_add_bent_tube(scene *s, const double (*corners)[3], int count, double radius, double step);

/* Moves vertices first .. end - 1 of the positions x. */
void shift_vertices(uint32_t first, uint32_t end, const double by[3], double *x);

/* ---- partitions made by hand --------------------------------------------------------------------------- */

/* Makes a partition of generation 1 whose parts all belong to different objects. A part has the vertices
 * whose first triangle it has, so a part with triangles may have no vertices and no cells. Each vertex
 * goes to the nearest of up to cells_max random centres (tests/support/random.h). triangle_parts: NULL for
 * the components. */
sensor_partition *hand_partition_create(const cscd_mesh *mesh, const double *positions,
                                        const uint32_t *triangle_parts, uint32_t part_count,
                                        uint32_t cells_max);
void hand_partition_destroy(sensor_partition *partition);

/* Chooses a random vertex of each cell; `out` has room for as many as there are vertices. */
void hand_partition_particles(const sensor_partition *partition, uint32_t *out);

/* ---- partitions ---------------------------------------------------------------------------------------- */

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
