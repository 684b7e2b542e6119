/* Keeps one particle in every cell of a partition, also when cells are renewed. */
#pragma once

#include "sensors/particles.h"
#include "sensors/partition.h"

/* Places the particles for the partition's present generation at positions x: particles of older cells stay
 * where they are, those of new cells begin at the vertex next to the middle. With p->count 0 all cells are
 * new. *generation is the one that the particles were placed for. */
cscd_status cell_particles_place(particles *p, const sensor_partition *partition, uint64_t *generation,
                                 const double *x);

/* Particles of one group do not attract each other. A group is an object, or, by_parts, a part; all obstacles
 * are one group. */
uint32_t particle_group(const sensor_partition *partition, uint32_t part, bool by_parts);
