/* A hashed uniform grid that finds particles by their places; every round builds it again by counting
 * sort. */
#include "sensors/particle_grid.h"

#include "src/core/vec3.h"

#include <assert.h>

enum { BUCKETS_LEAST = 8 };

/* Grid cells are numbered from 0 to this, so that the rounding of a quotient stays far below one cell; a
 * larger scene gets larger cells. */
static const double cells_most = 0x1p30;

static uint32_t buckets_for(uint32_t count) {
    uint32_t buckets = BUCKETS_LEAST;
    while (buckets < count && buckets < 0x80000000u) buckets *= 2;
    return buckets;
}

static array_list list_arrays(particle_grid *grid) {
    return (array_list){{ARRAY(grid->first, (size_t)grid->mask + 2), ARRAY(grid->buckets, grid->capacity),
                         ARRAY(grid->entries, grid->capacity)}};
}

cscd_status particle_grid_reserve(cscd_context *context, particle_grid *grid, uint32_t count) {
    if (count <= grid->capacity && grid->first != NULL) return CSCD_OK;
    uint32_t buckets = buckets_for(count);
    particle_grid wider = {.capacity = count, .mask = buckets - 1};
    if (!context_allocate_all(context, list_arrays(&wider))) return CSCD_OUT_OF_MEMORY;
    particle_grid_free(context, grid);
    *grid = wider;
    return CSCD_OK;
}

void particle_grid_free(cscd_context *context, particle_grid *grid) {
    context_free_all(context, list_arrays(grid));
    *grid = (particle_grid){0};
}

/* The number of the cell along one axis; -2 lies before all cells, cells_most + 2 behind all. */
static uint32_t cell_along(const particle_grid *grid, const double x[3], int axis) {
    double cell = floor((x[axis] - grid->origin[axis]) * grid->cells_per_length);
    return (uint32_t)(int64_t)min_of(max_of(cell, -2.0), cells_most + 2.0);
}

/* Two particles nearer than radius lie in the same or in adjoining cells: cells are wider than the radius by
 * far more than the rounding of a cell's number. */
static void fit_grid(particle_grid *grid, const double *x, const uint32_t *vertices, uint32_t count,
                     double radius) {
    double low[3] = {0}, high[3] = {0}, extent = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            double c = x[(size_t)vertices[i] * 3 + (size_t)k];
            low[k] = i == 0 ? c : min_of(low[k], c);
            high[k] = i == 0 ? c : max_of(high[k], c);
        }
    }
    for (int k = 0; k < 3; k++) extent = max_of(extent, high[k] - low[k]);
    memcpy(grid->origin, low, sizeof low);
    grid->cells_per_length = 1.0 / max_of(radius * (1.0 + 0x1p-10), extent / cells_most);
}

void particle_grid_build(particle_grid *grid, const double *x, const uint32_t *vertices,
                         const uint32_t *groups, uint32_t count, double radius) {
    assert(count <= grid->capacity);
    fit_grid(grid, x, vertices, count, radius);
    grid->count = count;
    memset(grid->first, 0, ((size_t)grid->mask + 2) * sizeof *grid->first);
    for (uint32_t i = 0; i < count; i++) {
        const double *at = x + (size_t)vertices[i] * 3;
        uint32_t row = grid_row_bucket(cell_along(grid, at, 1), cell_along(grid, at, 2));
        grid->buckets[i] = (row + cell_along(grid, at, 0)) & grid->mask;
        grid->first[grid->buckets[i] + 1]++;
    }
    for (uint32_t b = 0; b <= grid->mask; b++) grid->first[b + 1] += grid->first[b];
    for (uint32_t i = count; i-- > 0;) { /* first[b + 1] goes down from the bucket's end to its beginning, */
        const double *at = x + (size_t)vertices[i] * 3;
        grid_entry *e = &grid->entries[--grid->first[grid->buckets[i] + 1]];
        memcpy(e->x, at, sizeof e->x);
        e->particle = i;
        e->group = groups[i];
        e->y = cell_along(grid, at, 1);
        e->z = cell_along(grid, at, 2);
    }
    memmove(grid->first, grid->first + 1, ((size_t)grid->mask + 1) * sizeof *grid->first); /* which is here */
    grid->first[grid->mask + 1] = count;
}

grid_search particle_grid_around(const particle_grid *grid, const double x[3]) {
    grid_search s = {.grid = grid};
    s.x = cell_along(grid, x, 0) - 1;
    s.y = cell_along(grid, x, 1) - 1;
    s.z = cell_along(grid, x, 2) - 1;
    grid_search_row(&s);
    grid_search_open(&s);
    return s;
}
