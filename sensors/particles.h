/* Particles that walk from vertex to vertex, and the grid that finds them by their places. */
#pragma once

#include "src/core/context.h"

/* ---- a grid that finds particles ----------------------------------------------------------------------- */

/* The grid is hashed and uniform, and finds particles by their places; every round builds it again by counting
 * sort. */
typedef struct grid_entry {
    double x[3];
    uint32_t particle, group; /* particles of one group ignore each other */
    uint32_t y, z;            /* the row of its grid cell */
} grid_entry;

/* Cells that differ in x only lie in consecutive buckets, so the 27 cells around a point are 9 short runs of
 * memory. Different cells may share a bucket: entries say in which row they are, and distances tell the
 * rest. */
typedef struct particle_grid {
    double origin[3], cells_per_length;
    uint32_t mask;     /* buckets - 1 */
    uint32_t *first;   /* entries of bucket b: first[b] .. first[b + 1] */
    uint32_t *buckets; /* per particle */
    grid_entry *entries;
    uint32_t count, capacity;
} particle_grid;

/* Makes room for count particles. */
cscd_status particle_grid_reserve(cscd_context *context, particle_grid *grid, uint32_t count);
void particle_grid_free(cscd_context *context, particle_grid *grid);

/* Builds the grid of particles i at vertices[i] of x, in groups[i]. Searches around a point find all entries
 * nearer than radius. count is at most the number that was reserved. */
void particle_grid_build(particle_grid *grid, const double *x, const uint32_t *vertices,
                         const uint32_t *groups, uint32_t count, double radius);

/* A search around a point, which particle_grid_around begins. */
typedef struct grid_search {
    const particle_grid *grid;
    uint32_t x, y, z;     /* the first of its 27 cells */
    uint32_t row, column; /* the current one of 9 rows of 3 cells */
    uint32_t row_y, row_z, bucket;
    uint32_t next, end; /* entries of that bucket */
} grid_search;

grid_search particle_grid_around(const particle_grid *grid, const double x[3]);

static inline void grid_search_open(grid_search *s) {
    uint32_t bucket = (s->bucket + s->column) & s->grid->mask;
    s->next = s->grid->first[bucket];
    s->end = s->grid->first[bucket + 1];
}

/* The bucket at which a row begins. */
static inline uint32_t grid_row_bucket(uint32_t y, uint32_t z) {
    uint64_t h = ((uint64_t)z << 32 | y) * UINT64_C(0x9E3779B97F4A7C15);
    return (uint32_t)(h >> 32);
}

static inline void grid_search_row(grid_search *s) {
    s->row_y = s->y + s->row % 3;
    s->row_z = s->z + s->row / 3;
    s->bucket = grid_row_bucket(s->row_y, s->row_z) + s->x;
}

/* Returns the next entry that may be within the radius, each once, and NULL at the end. */
static inline const grid_entry *grid_search_next(grid_search *s) {
    for (;;) {
        while (s->next < s->end) {
            const grid_entry *e = &s->grid->entries[s->next++];
            if (e->y == s->row_y && e->z == s->row_z) return e;
        }
        if (++s->column == 3) {
            s->column = 0;
            if (++s->row == 9) return NULL;
            grid_search_row(s);
        }
        grid_search_open(s);
    }
}

/* ---- particles ----------------------------------------------------------------------------------------- */

/* A rule chooses the vertex that a particle walks to. All rules use attractions of 1 / r^2 that end at R_eff
 * (3.12, 3.13), and choose the best vertex within the cell; in the thesis the particle stays when a vertex
 * outside is better (3.15 to 3.17).
 *
 * The thesis adds attractions as vectors. Then two that pull to opposite sides cancel, and many far ones
 * outweigh the one at which there is a contact. With the strongest one alone, particles of two objects that
 * touch end where they are nearest, whatever else is around: the exact check confirms more contacts, and far
 * particles cost little, since they can be dropped. Two particles also rest where only a move of both at once
 * would bring them nearer, for instance side by side on two round surfaces. No rule that moves single particles
 * avoids that. */
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
