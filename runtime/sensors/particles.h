/* Particles: the forces that they feel on vertices, and how they walk until all rest. */
#pragma once

#include "runtime/sensors/particle_grid.h"

/* Where a particle walks to: every rule is of attractions of 1 / r^2 that end at R_eff (3.12, 3.13), and of
 * the best vertex within its cell, where the thesis has it stay when a vertex outside is better (3.15
 * to 3.17).
 *
 * The thesis adds attractions as vectors. Then two that pull to opposite sides cancel, and many far ones
 * outdo the one at which there is a contact. By the strongest alone particles of two objects that touch end
 * where they are nearest, whatever else is around; the exact check confirms more (docs/sensors.md compares
 * them), and what is far costs little, since it can be dropped. Two particles also rest where only a move of
 * both at once would bring them nearer: side by side on two round surfaces, say. No rule of one particle's
 * own moves sees that. */
typedef enum particle_rule {
    PARTICLE_ATTRACTION, /* where the sum of attractions, as vectors, is longest (3.14): the thesis's */
    PARTICLE_SCALAR,     /* where the sum of their magnitudes is largest */
    PARTICLE_STRONGEST,  /* where the largest of them is largest: as near to another one as it gets */
    PARTICLE_POTENTIAL   /* where the potential of attractions and of repulsions in its object is least */
} particle_rule;

/* Vertices that x can be left for: targets[offsets[x] .. offsets[x + 1]), ascending. */
typedef struct vertex_ways {
    const uint32_t *offsets, *targets;
} vertex_ways;

typedef struct particle_counters {
    uint64_t rounds, vertices, pairs, distances;
} particle_counters;

enum { PARTICLES_RECENT = 8 };

typedef struct particles {
    cscd_context *context;
    particle_rule rule;
    vertex_ways ways;
    uint32_t count, capacity;
    uint32_t *vertices; /* where each is */
    uint32_t *groups;   /* particles of one group do not attract each other */
    uint32_t *objects;  /* PARTICLE_POTENTIAL: those of one object push each other apart */
    uint32_t *targets;  /* where each goes next */
    uint32_t *kept;     /* a state to come back to */
    double (*near)[3];  /* those around a particle: attracting ones from the front, repelling from the back */
    uint32_t attracting, repelling;
    particle_grid grid;

    double radius;      /* R_eff */
    double longest_way; /* no way is longer */
    double closest;     /* distances count as at least this, so that forces stay finite */

    uint64_t state;                    /* a hash of all vertices */
    uint64_t recent[PARTICLES_RECENT]; /* of the last rounds, and one of an older round */
    uint64_t landmark;
    uint32_t landmark_round, rounds; /* of the walk at hand */
    particle_counters counters;
} particles;

/* Room for count particles; what they were is kept. */
cscd_status particles_reserve(particles *p, uint32_t count);
void particles_free(particles *p);

/* A walk at positions x begins. */
void particles_begin(particles *p);

/* All move at once, by at most one edge. The number that moved. */
uint32_t particles_round(particles *p, const double *x);

/* Rounds until nothing moves (0), limit rounds are done (0), or a state has come back: then after how many
 * rounds it does so. */
uint32_t particles_settle(particles *p, const double *x, uint32_t limit);

void particles_keep(particles *p);
void particles_return(particles *p);
