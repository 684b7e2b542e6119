/* Partitions made by hand: triangles may be in any part, and cells lie about random vertices. */
#pragma once

#include "cscd/sensors.h"
#include "sensors/partition.h"

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
