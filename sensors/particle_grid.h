/* A hashed uniform grid that finds particles by their places; every round builds it again by counting
 * sort. */
#pragma once

#include "src/core/context.h"

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
