/* The older method: a fixed number of particles on every object, from random vertices (Senin et al. 2003). */
#pragma once

#include "sensors/particles.h"
#include "sensors/partition.h"

/* The objects and edges that these particles walk on. */
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
