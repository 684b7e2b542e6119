/* A particle in every cell of a partition, and what becomes of them when cells are made anew. */
#pragma once

#include "runtime/sensors/particles.h"
#include "src/mesh/partition.h"

/* The particles of a partition's generation at positions x: those of older parts stay where they are, those
 * of new cells begin next to their cell's middle. With count 0 all cells are new. *generation is of the
 * partition that they were made for. */
cscd_status cell_particles_place(particles *p, const cscd_partition *partition, uint64_t *generation,
                                 const double *x);

/* Particles of one group do not attract each other: of an object, or of a part where parts of one object are
 * watched; all obstacles are one. */
uint32_t particle_group(const cscd_partition *partition, uint32_t part, bool by_parts);
