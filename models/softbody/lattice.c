/* A lattice of cubes around a closed surface: the lattice is simulated, and carries the surface along. */
#include "models/common/vec3.h"
#include "models/shapes/body.h"
#include "models/softbody/softbody.h"

#include <stdlib.h>
#include <string.h>

enum { UNKNOWN, OUTSIDE, SURFACE };

/* The cells of a box that holds the surface and a layer around it. */
typedef struct cell_grid {
    uint32_t size[3];
    double low[3], spacing;
    uint8_t *kinds;
} cell_grid;

static size_t cell_at(const cell_grid *g, uint32_t x, uint32_t y, uint32_t z) {
    return ((size_t)z * g->size[1] + y) * g->size[0] + x;
}

static cell_grid make_grid(const double *positions, uint32_t vertex_count, double spacing) {
    cell_grid g = {.spacing = spacing};
    for (uint32_t k = 0; k < 3; k++) {
        double low = positions[k], high = positions[k];
        for (uint32_t v = 1; v < vertex_count; v++) {
            low = fmin(low, positions[v * 3 + k]);
            high = fmax(high, positions[v * 3 + k]);
        }
        g.size[k] = (uint32_t)ceil((high - low) / spacing) + 3;
        g.low[k] = 0.5 * (low + high - g.size[k] * spacing);
    }
    g.kinds = body_allocate((size_t)g.size[0] * g.size[1] * g.size[2], sizeof *g.kinds);
    return g;
}

static void find_cell(const cell_grid *g, const double p[3], uint32_t cell[3]) {
    for (int k = 0; k < 3; k++) cell[k] = (uint32_t)((p[k] - g->low[k]) / g->spacing);
}

static void mark_surface(cell_grid *g, const double *positions, uint32_t vertex_count,
                         const uint32_t *triangles, uint32_t triangle_count) {
    for (uint32_t v = 0; v < vertex_count; v++) {
        uint32_t cell[3];
        find_cell(g, positions + v * 3, cell);
        g->kinds[cell_at(g, cell[0], cell[1], cell[2])] = SURFACE;
    }
    for (uint32_t t = 0; t < triangle_count; t++) {
        const double *a = positions + triangles[t * 3] * 3, *b = positions + triangles[t * 3 + 1] * 3,
                     *c = positions + triangles[t * 3 + 2] * 3;
        double ab[3], ac[3];
        vec3_subtract(b, a, ab);
        vec3_subtract(c, a, ac);
        int steps = 1 + (int)(4.0 * fmax(vec3_norm(ab), vec3_norm(ac)) / g->spacing);
        for (int i = 0; i <= steps; i++) {
            for (int j = 0; i + j <= steps; j++) {
                double p[3] = {a[0], a[1], a[2]};
                uint32_t cell[3];
                vec3_add_scaled(p, (double)i / steps, ab);
                vec3_add_scaled(p, (double)j / steps, ac);
                find_cell(g, p, cell);
                g->kinds[cell_at(g, cell[0], cell[1], cell[2])] = SURFACE;
            }
        }
    }
}

/* Floods from a corner of the grid through all cells that the surface does not touch. */
static void flood_outside(cell_grid *g) {
    size_t count = (size_t)g->size[0] * g->size[1] * g->size[2], pending = 1;
    size_t *stack = body_allocate(count, sizeof *stack);
    const size_t strides[3] = {1, g->size[0], (size_t)g->size[0] * g->size[1]};
    g->kinds[0] = OUTSIDE;
    stack[0] = 0;
    while (pending > 0) {
        size_t cell = stack[--pending];
        for (int k = 0; k < 3; k++) {
            size_t place = cell / strides[k] % g->size[k];
            for (int way = 0; way < 2; way++) {
                if (way == 0 ? place == 0 : place + 1 == g->size[k]) continue;
                size_t next = way == 0 ? cell - strides[k] : cell + strides[k];
                if (g->kinds[next] != UNKNOWN) continue;
                g->kinds[next] = OUTSIDE;
                stack[pending++] = next;
            }
        }
    }
    free(stack);
}

static uint32_t node_of(lattice *l, uint32_t *nodes, const cell_grid *g, const uint32_t at[3]) {
    uint32_t *node = nodes + ((size_t)at[2] * (g->size[1] + 1) + at[1]) * (g->size[0] + 1) + at[0];
    if (*node == UINT32_MAX) {
        for (uint32_t k = 0; k < 3; k++) l->rest[l->node_count * 3 + k] = g->low[k] + at[k] * g->spacing;
        *node = l->node_count++;
    }
    return *node;
}

/* Numbers nodes and cells in the order of the grid; cell_numbers gets the number of each cell. */
static void collect_cells(lattice *l, const cell_grid *g, uint32_t *cell_numbers) {
    size_t nodes_max = (size_t)(g->size[0] + 1) * (g->size[1] + 1) * (g->size[2] + 1);
    size_t cells_max = (size_t)g->size[0] * g->size[1] * g->size[2];
    uint32_t *nodes = body_allocate(nodes_max, sizeof *nodes), at[3];
    memset(nodes, 0xff, nodes_max * sizeof *nodes);
    l->rest = body_allocate(nodes_max, 3 * sizeof *l->rest);
    l->cells = body_allocate(cells_max, sizeof *l->cells);
    l->parities = body_allocate(cells_max, sizeof *l->parities);
    for (at[2] = 0; at[2] < g->size[2]; at[2]++) {
        for (at[1] = 0; at[1] < g->size[1]; at[1]++) {
            for (at[0] = 0; at[0] < g->size[0]; at[0]++) {
                if (g->kinds[cell_at(g, at[0], at[1], at[2])] == OUTSIDE) continue;
                for (uint32_t i = 0; i < 8; i++) {
                    const uint32_t corner[3] = {at[0] + (i & 1), at[1] + (i >> 1 & 1), at[2] + (i >> 2)};
                    l->cells[l->cell_count][i] = node_of(l, nodes, g, corner);
                }
                l->parities[l->cell_count] = (at[0] + at[1] + at[2]) % 2;
                cell_numbers[cell_at(g, at[0], at[1], at[2])] = l->cell_count++;
            }
        }
    }
    free(nodes);
}

static void hang_vertices(lattice *l, const cell_grid *g, const uint32_t *cell_numbers,
                          const double *positions) {
    l->vertex_cells = body_allocate(l->vertex_count, sizeof *l->vertex_cells);
    l->vertex_shares = body_allocate(l->vertex_count, sizeof *l->vertex_shares);
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        uint32_t at[3];
        double part[3];
        find_cell(g, positions + v * 3, at);
        for (uint32_t k = 0; k < 3; k++) part[k] = (positions[v * 3 + k] - g->low[k]) / g->spacing - at[k];
        l->vertex_cells[v] = cell_numbers[cell_at(g, at[0], at[1], at[2])];
        for (uint32_t i = 0; i < 8; i++) {
            l->vertex_shares[v][i] = 1.0;
            for (int k = 0; k < 3; k++) l->vertex_shares[v][i] *= i >> k & 1 ? part[k] : 1.0 - part[k];
        }
    }
}

lattice lattice_make(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                     uint32_t triangle_count, double spacing) {
    lattice l = {.vertex_count = vertex_count, .spacing = spacing};
    cell_grid g = make_grid(positions, vertex_count, spacing);
    uint32_t *cell_numbers = body_allocate((size_t)g.size[0] * g.size[1] * g.size[2], sizeof *cell_numbers);
    mark_surface(&g, positions, vertex_count, triangles, triangle_count);
    flood_outside(&g);
    collect_cells(&l, &g, cell_numbers);
    hang_vertices(&l, &g, cell_numbers, positions);
    free(cell_numbers);
    free(g.kinds);
    return l;
}

void lattice_free(lattice *l) {
    free(l->rest);
    free(l->cells);
    free(l->parities);
    free(l->vertex_cells);
    free(l->vertex_shares);
    *l = (lattice){0};
}

void lattice_place_vertex(const lattice *l, const double *nodes, uint32_t vertex, double position[3]) {
    const uint32_t *corners = l->cells[l->vertex_cells[vertex]];
    position[0] = position[1] = position[2] = 0.0;
    for (int i = 0; i < 8; i++)
        vec3_add_scaled(position, l->vertex_shares[vertex][i], nodes + corners[i] * 3);
}

void lattice_place_vertices(const lattice *l, const double *nodes, double *positions) {
    for (uint32_t v = 0; v < l->vertex_count; v++) lattice_place_vertex(l, nodes, v, positions + v * 3);
}
