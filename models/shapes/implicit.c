/* Meshes of implicit surfaces, by surface nets. */
#include "models/shapes/implicit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct grid {
    uint32_t size[3]; /* points along x, y, z */
    double low[3], spacing;
    double *values;
    uint32_t *cells; /* vertex of the cell that starts at this point, or UINT32_MAX */
} grid;

static size_t grid_index(const grid *g, uint32_t x, uint32_t y, uint32_t z) {
    return ((size_t)z * g->size[1] + y) * g->size[0] + x;
}

/* Samples along x. Points that the zero set cannot come near get the value before them: only their sign is used. */
static void sample_row(const implicit *surface, grid *g, uint32_t y, uint32_t z) {
    double p[3] = {0.0, g->low[1] + y * g->spacing, g->low[2] + z * g->spacing};
    double *row = g->values + grid_index(g, 0, y, z);
    for (uint32_t x = 0; x < g->size[0];) {
        p[0] = g->low[0] + x * g->spacing;
        double value = surface->distance(p), far = fabs(value) / (IMPLICIT_STEEPEST * g->spacing) - 2.0;
        uint32_t end = x + 1 + (uint32_t)fmin(fmax(far, 0.0), g->size[0]);
        for (; x < end && x < g->size[0]; x++) row[x] = value;
    }
}

static grid sample_grid(const implicit *surface, double spacing) {
    const double *low = surface->low, *high = surface->high;
    grid g = {.spacing = spacing};
    for (int k = 0; k < 3; k++) {
        g.low[k] = low[k];
        g.size[k] = (uint32_t)ceil((high[k] - low[k]) / spacing) + 1;
    }
    size_t count = (size_t)g.size[0] * g.size[1] * g.size[2];
    g.values = body_allocate(count, sizeof *g.values);
    g.cells = body_allocate(count, sizeof *g.cells);
    memset(g.cells, 0xff, count * sizeof *g.cells);
    for (uint32_t z = 0; z < g.size[2]; z++)
        for (uint32_t y = 0; y < g.size[1]; y++) sample_row(surface, &g, y, z);
    return g;
}

static bool corner_is_inside(const grid *g, const uint32_t at[3], uint32_t step_axis, uint32_t other_axis) {
    uint32_t p[3] = {at[0], at[1], at[2]};
    if (step_axis < 3) p[step_axis]++;
    if (other_axis < 3) p[other_axis]++;
    return g->values[grid_index(g, p[0], p[1], p[2])] < 0.0;
}

/* Whether the inner corners of a cell, or the outer ones, fall apart into two groups: two corners on a diagonal of a
 * face, or two opposite corners of the cell. One vertex would then join two sheets of the surface. Three faces are
 * looked at; the other three are faces of the next cells. */
static bool joins_sheets(const grid *g, const uint32_t at[3]) {
    for (uint32_t u = 0; u < 3; u++) {
        uint32_t v = (u + 1) % 3;
        bool here = corner_is_inside(g, at, 3, 3), across = corner_is_inside(g, at, u, v);
        if (here == across && here != corner_is_inside(g, at, u, 3) && here != corner_is_inside(g, at, v, 3))
            return true;
    }
    uint32_t inside = 0;
    for (uint32_t i = 0; i < 8; i++) {
        size_t corner = grid_index(g, at[0] + (i & 1), at[1] + (i >> 1 & 1), at[2] + (i >> 2));
        inside |= (uint32_t)(g->values[corner] < 0.0) << i;
    }
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t opposite = 1u << i | 1u << (7 - i);
        if (inside == opposite || inside == (0xff ^ opposite)) return true;
    }
    return false;
}

static bool is_ambiguous(const grid *g) {
    uint32_t at[3];
    for (at[2] = 0; at[2] + 1 < g->size[2]; at[2]++) {
        for (at[1] = 0; at[1] + 1 < g->size[1]; at[1]++) {
            for (at[0] = 0; at[0] + 1 < g->size[0]; at[0]++)
                if (joins_sheets(g, at)) return true;
        }
    }
    return false;
}

/* Adds the vertex of a cell: the mean of the points where the surface crosses the cell's edges. */
static void add_cell_vertex(body *b, grid *g, const uint32_t at[3]) {
    double sum[3] = {0.0, 0.0, 0.0};
    int crossings = 0;
    for (uint32_t from = 0; from < 8; from++) {
        for (uint32_t axis = 0; axis < 3; axis++) {
            uint32_t to = from | 1u << axis;
            if (to == from) continue;
            double v0 =
                g->values[grid_index(g, at[0] + (from & 1), at[1] + (from >> 1 & 1), at[2] + (from >> 2))];
            double v1 = g->values[grid_index(g, at[0] + (to & 1), at[1] + (to >> 1 & 1), at[2] + (to >> 2))];
            if ((v0 < 0.0) == (v1 < 0.0)) continue;
            for (uint32_t k = 0; k < 3; k++)
                sum[k] += at[k] + (from >> k & 1) + (k == axis ? v0 / (v0 - v1) : 0.0);
            crossings++;
        }
    }
    if (crossings == 0) return;
    for (int k = 0; k < 3; k++) sum[k] = g->low[k] + g->spacing * sum[k] / crossings;
    g->cells[grid_index(g, at[0], at[1], at[2])] = body_add_vertex(b, sum[0], sum[1], sum[2]);
}

static double squared_distance(const body *b, uint32_t v, uint32_t w) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double d = b->positions[v * 3 + (uint32_t)k] - b->positions[w * 3 + (uint32_t)k];
        sum += d * d;
    }
    return sum;
}

/* Finds the four cells around a grid edge that the surface crosses, counter-clockwise from outside. */
static bool edge_quad(const grid *g, const uint32_t at[3], uint32_t axis, uint32_t corner[4]) {
    uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3, end[3] = {at[0], at[1], at[2]};
    end[axis]++;
    double here = g->values[grid_index(g, at[0], at[1], at[2])];
    double there = g->values[grid_index(g, end[0], end[1], end[2])];
    if ((here < 0.0) == (there < 0.0)) return false;
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t cell[3] = {at[0], at[1], at[2]};
        cell[u] -= i == 0 || i == 3;
        cell[v] -= i < 2;
        corner[here < 0.0 ? i : 3 - i] = g->cells[grid_index(g, cell[0], cell[1], cell[2])];
    }
    return true;
}

/* Splits a quad along its shorter diagonal. A vertex of two quads gets both diagonals, which would
 * otherwise be one edge. */
static void split_quad(body *b, const uint32_t corner[4], const uint8_t *valences) {
    bool across = squared_distance(b, corner[1], corner[3]) < squared_distance(b, corner[0], corner[2]);
    if (valences[corner[0]] == 2 || valences[corner[2]] == 2) across = false;
    if (valences[corner[1]] == 2 || valences[corner[3]] == 2) across = true;
    uint32_t first = across ? 1 : 0;
    body_add_triangle(b, corner[first], corner[first + 1], corner[first + 2]);
    body_add_triangle(b, corner[first], corner[first + 2], corner[(first + 3) % 4]);
}

/* Visits all quads: the first pass counts valences, the second adds triangles. */
static void visit_quads(body *b, const grid *g, uint8_t *valences, bool counting) {
    uint32_t at[3], corner[4];
    for (at[2] = 1; at[2] + 1 < g->size[2]; at[2]++) {
        for (at[1] = 1; at[1] + 1 < g->size[1]; at[1]++) {
            for (at[0] = 1; at[0] + 1 < g->size[0]; at[0]++) {
                for (uint32_t axis = 0; axis < 3; axis++) {
                    if (!edge_quad(g, at, axis, corner)) continue;
                    for (int i = 0; counting && i < 4; i++) valences[corner[i]]++;
                    if (!counting) split_quad(b, corner, valences);
                }
            }
        }
    }
}

void implicit_project(const implicit *surface, double scale, double p[3]) {
    for (int round = 0; round < 3; round++) {
        double gradient[3], value = surface->distance(p), squared = 0.0, step = 1e-4 * scale;
        for (int k = 0; k < 3; k++) {
            double q[3] = {p[0], p[1], p[2]};
            q[k] += step;
            gradient[k] = (surface->distance(q) - value) / step;
            squared += gradient[k] * gradient[k];
        }
        for (int k = 0; squared > 0.01 && k < 3; k++) p[k] -= value * gradient[k] / squared;
        if (fabs(value) < 1e-3 * scale) return;
    }
}

double body_add_implicit(body *b, const implicit *surface, double spacing) {
    uint32_t at[3];
    grid g = sample_grid(surface, spacing);
    while (is_ambiguous(&g)) {
        free(g.values);
        free(g.cells);
        spacing *= 0.97;
        g = sample_grid(surface, spacing);
    }
    for (at[2] = 0; at[2] + 1 < g.size[2]; at[2]++) {
        for (at[1] = 0; at[1] + 1 < g.size[1]; at[1]++) {
            for (at[0] = 0; at[0] + 1 < g.size[0]; at[0]++) add_cell_vertex(b, &g, at);
        }
    }
    uint8_t *valences = body_allocate(b->vertex_count, sizeof *valences);
    visit_quads(b, &g, valences, true);
    visit_quads(b, &g, valences, false);
    free(valences);
    free(g.values);
    free(g.cells);
    return spacing;
}
