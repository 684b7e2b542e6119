/* Partitions put together by hand: any triangles to any parts, cells about random vertices. */
#pragma once

#include "src/mesh/partition.h"

/* A part's vertices are those whose first triangle is the part's; so a part may have triangles, but no
 * vertices and no cells. Each goes to the nearest of up to cells_max random ones (tests/support/random.h).
 * All parts are of different objects. Generation 1. triangle_parts NULL: the components. */
cscd_partition *hand_partition_create(const cscd_mesh *mesh, const double *positions,
                                      const uint32_t *triangle_parts, uint32_t part_count,
                                      uint32_t cells_max);
void hand_partition_destroy(cscd_partition *partition);

/* Chooses a random vertex of each cell; `out` has room for as many as there are vertices. */
void hand_partition_particles(const cscd_partition *partition, uint32_t *out);
