/* The places at which particles begin: one in every cell, also when cells are renewed; or some on every
 * object, at random. */
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

/* ---- at random ----------------------------------------------------------------------------------------- */

/* The older method: a fixed number of particles on every object, from random vertices (Senin et al. 2003). The objects and
 * edges that they walk on. */
typedef struct random_particles {
    uint32_t *object_offsets, *object_vertices; /* vertices with a triangle */
    uint32_t *neighbour_offsets, *neighbours;   /* per vertex, ascending */
    uint32_t object_count, vertex_count;
    size_t neighbour_count;
} random_particles;

cscd_status random_particles_create(const sensor_partition *partition, random_particles *out);
/* A structure of zeros is left as it is. */
void random_particles_free(cscd_context *context, random_particles *r);

/* Puts per_object particles, or as many as there are vertices, on different vertices of every object. */
cscd_status random_particles_place(const random_particles *r, const sensor_partition *partition,
                                   uint32_t per_object, uint32_t seed, particles *p);
