/* Particles: the forces that they feel on vertices, and how they walk until all rest. */
#pragma once

#include "sensors/particle_grid.h"

/* A rule chooses the vertex that a particle walks to. All rules use attractions of 1 / r^2 that end at R_eff
 * (3.12, 3.13), and choose the best vertex within the cell; in the thesis the particle stays when a vertex
 * outside is better (3.15 to 3.17).
 *
 * The thesis adds attractions as vectors. Then two that pull to opposite sides cancel, and many far ones
 * outweigh the one at which there is a contact. With the strongest one alone, particles of two objects that
 * touch end where they are nearest, whatever else is around: the exact check confirms more contacts
 * (docs/theory/sensors.md compares the rules), and far particles cost little, since they can be dropped. Two
 * particles also rest where only a move of both at once would bring them nearer, for instance side by side on
 * two round surfaces. No rule that moves single particles avoids that. */
typedef enum particle_rule {
    PARTICLE_ATTRACTION, /* where the sum of attractions, as vectors, is longest (3.14), as in the thesis */
    PARTICLE_SCALAR,     /* where the sum of their magnitudes is largest */
    PARTICLE_STRONGEST,  /* where the largest of them is largest: as near to another one as it gets */
    PARTICLE_POTENTIAL   /* where the potential of attractions and of repulsions in its object is least */
} particle_rule;

/* The vertices that a particle at x can step to: targets[offsets[x] .. offsets[x + 1]), ascending. */
typedef struct vertex_steps {
    const uint32_t *offsets, *targets;
} vertex_steps;

typedef struct particle_counters {
    uint64_t rounds, vertices, pairs, distances;
} particle_counters;

enum { PARTICLES_RECENT = 8 };

typedef struct particles {
    cscd_context *context;
    particle_rule rule;
    vertex_steps steps;
    uint32_t count, capacity;
    uint32_t *vertices; /* the vertex of each particle */
    uint32_t *groups;   /* particles of one group do not attract each other */
    uint32_t *objects;  /* PARTICLE_POTENTIAL: those of one object push each other apart */
    uint32_t *targets;  /* where each goes next */
    uint32_t *kept;     /* the state that particles_return restores */
    double (*near)[3]; /* around one particle: attracting ones from the front, repelling ones from the back */
    uint32_t attracting, repelling;
    particle_grid grid;

    double radius;       /* R_eff */
    double longest_step; /* no step is longer */
    double closest;      /* distances count as at least this, so that forces stay finite */

    uint64_t state;                    /* a hash of all vertices */
    uint64_t recent[PARTICLES_RECENT]; /* of the last rounds, and one of an older round */
    uint64_t landmark;
    uint32_t landmark_round, rounds; /* of this walk */
    particle_counters counters;
} particles;

/* Makes room for count particles, and keeps those that there are. */
cscd_status particles_reserve(particles *p, uint32_t count);
void particles_free(particles *p);

/* Begins a walk. */
void particles_begin(particles *p);

/* Moves all particles at once, each by at most one edge. Returns how many moved. */
uint32_t particles_round(particles *p, const double *x);

/* Runs rounds until nothing moves or limit rounds are done, and returns 0; or until a state comes back, and
 * returns after how many rounds it does. */
uint32_t particles_settle(particles *p, const double *x, uint32_t limit);

/* Keeps the state, and goes back to the one that was kept. */
void particles_keep(particles *p);
void particles_return(particles *p);
