/* Meshes of implicit surfaces, by surface nets, and made even with an exact number of triangles. */
#include "models/shapes/implicit.h"

#include "models/shapes/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- surface nets -------------------------------------------------------------------------------------- */

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
static void sample_row(const implicit *shape, grid *g, uint32_t y, uint32_t z) {
    double p[3] = {0.0, g->low[1] + y * g->spacing, g->low[2] + z * g->spacing};
    double *row = g->values + grid_index(g, 0, y, z);
    for (uint32_t x = 0; x < g->size[0];) {
        p[0] = g->low[0] + x * g->spacing;
        double value = shape->distance(p), far = fabs(value) / (IMPLICIT_STEEPEST * g->spacing) - 2.0;
        uint32_t end = x + 1 + (uint32_t)fmin(fmax(far, 0.0), g->size[0]);
        for (; x < end && x < g->size[0]; x++) row[x] = value;
    }
}

static grid sample_grid(const implicit *shape, double spacing) {
    const double *low = shape->low, *high = shape->high;
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
        for (uint32_t y = 0; y < g.size[1]; y++) sample_row(shape, &g, y, z);
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

void implicit_project(const implicit *shape, double scale, double p[3]) {
    for (int round = 0; round < 3; round++) {
        double gradient[3], value = shape->distance(p), squared = 0.0, step = 1e-4 * scale;
        for (int k = 0; k < 3; k++) {
            double q[3] = {p[0], p[1], p[2]};
            q[k] += step;
            gradient[k] = (shape->distance(q) - value) / step;
            squared += gradient[k] * gradient[k];
        }
        for (int k = 0; squared > 0.01 && k < 3; k++) p[k] -= value * gradient[k] / squared;
        if (fabs(value) < 1e-3 * scale) return;
    }
}

double body_add_implicit(body *b, const implicit *shape, double spacing) {
    uint32_t at[3];
    grid g = sample_grid(shape, spacing);
    while (is_ambiguous(&g)) {
        free(g.values);
        free(g.cells);
        spacing *= 0.97;
        g = sample_grid(shape, spacing);
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

/* ---- even triangles ------------------------------------------------------------------------------------ */

enum {
    EVEN_ROUNDS = 8,
    FINAL_ROUNDS = 12,
    PASSES_MAX = 400,
    NETS_LEAST = 6000, /* fewer triangles may lose a limb */
    NETS_MOST = 12000,
    NARROW_NETS_MOST = 64000 /* where parts nearly touch */
};

typedef struct surface_edge {
    double squared_length;
    uint32_t half_edge;
} surface_edge;

static int by_length(const void *a, const void *b) {
    const surface_edge *e = a, *f = b;
    if (e->squared_length != f->squared_length) return e->squared_length < f->squared_length ? -1 : 1;
    return (e->half_edge > f->half_edge) - (e->half_edge < f->half_edge);
}

/* Returns all edges, the shortest first, to be freed. */
static surface_edge *sorted_edges(const surface *s, uint32_t *count) {
    surface_edge *edges = body_allocate((size_t)s->live_triangles * 3 / 2, sizeof *edges);
    *count = 0;
    for (uint32_t h = 0; h < s->mesh.triangle_count * 3; h++)
        if (!triangle_is_dead(s, h / 3) && h < s->twins[h])
            edges[(*count)++] = (surface_edge){surface_squared_length(s, h), h};
    qsort(edges, *count, sizeof *edges, by_length);
    return edges;
}

static void edge_middle(const surface *s, const implicit *shape, uint32_t h, double scale, double at[3]) {
    const double *p = s->mesh.positions + (size_t)half_edge_from(s, h) * 3;
    const double *q = s->mesh.positions + (size_t)half_edge_to(s, h) * 3;
    for (int k = 0; k < 3; k++) at[k] = 0.5 * (p[k] + q[k]);
    implicit_project(shape, scale, at);
}

static void touch_neighbours(const surface *s, uint8_t *touched, uint32_t v) {
    uint32_t h = s->out[v];
    touched[v] = 1;
    do {
        touched[half_edge_to(s, h)] = 1;
        h = half_edge_turn(s, h);
    } while (h != s->out[v]);
}

/* Collapses up to `most` edges shorter than `below`, no two of them near each other; returns their number. */
static uint32_t collapse_shortest(surface *s, const implicit *shape, uint32_t most, double scale,
                                  double below) {
    uint32_t count, done = 0;
    surface_edge *edges = sorted_edges(s, &count);
    uint8_t *touched = body_allocate(s->mesh.vertex_count, sizeof *touched);
    for (uint32_t i = 0; i < count && done < most; i++) {
        uint32_t h = edges[i].half_edge;
        double at[3];
        if (edges[i].squared_length >= below * below) break;
        if (triangle_is_dead(s, h / 3)) continue;
        uint32_t a = half_edge_from(s, h), b = half_edge_to(s, h);
        if (touched[a] || touched[b] || surface_valence(s, a) + surface_valence(s, b) > 13) continue;
        edge_middle(s, shape, h, scale, at);
        if (!surface_collapse(s, h, at)) continue;
        touch_neighbours(s, touched, a);
        done++;
    }
    free(edges);
    free(touched);
    return done;
}

/* Splits up to `most` edges longer than `above`; returns their number. */
static uint32_t split_longest(surface *s, const implicit *shape, uint32_t most, double scale, double above) {
    uint32_t count, done = 0;
    surface_edge *edges = sorted_edges(s, &count);
    uint8_t *touched = body_allocate(s->mesh.vertex_count + count, sizeof *touched);
    for (uint32_t i = count; i-- > 0 && done < most;) {
        uint32_t h = edges[i].half_edge, a = half_edge_from(s, h), b = half_edge_to(s, h);
        double at[3];
        if (edges[i].squared_length <= above * above) break;
        if (touched[a] || touched[b]) continue;
        touch_neighbours(s, touched, a);
        touch_neighbours(s, touched, b);
        edge_middle(s, shape, h, scale, at);
        surface_split(s, h, at);
        touched[s->mesh.vertex_count - 1] = 1;
        done++;
    }
    free(edges);
    free(touched);
    return done;
}

static int excess_valence(uint32_t valence) {
    return (int)valence - 6;
}

/* Whether a flip brings the four valences nearer to 6. */
static bool evens_valences(const surface *s, uint32_t h) {
    uint32_t v[4] = {half_edge_from(s, h), half_edge_to(s, h), s->mesh.triangles[half_edge_previous(h)],
                     s->mesh.triangles[half_edge_previous(s->twins[h])]};
    int gain = 0;
    for (int i = 0; i < 4; i++) {
        int now = excess_valence(surface_valence(s, v[i])), then = now + (i < 2 ? -1 : 1);
        gain += now * now - then * then;
    }
    return gain > 0;
}

static double cotangent_at(const surface *s, uint32_t h) {
    const uint32_t *v = s->mesh.triangles;
    const double *x = s->mesh.positions, *p = x + (size_t)v[half_edge_previous(h)] * 3;
    const double *q = x + (size_t)v[h] * 3, *r = x + (size_t)v[half_edge_next(h)] * 3;
    double dot = 0.0, qq = 0.0, rr = 0.0;
    for (int k = 0; k < 3; k++) {
        dot += (q[k] - p[k]) * (r[k] - p[k]);
        qq += (q[k] - p[k]) * (q[k] - p[k]);
        rr += (r[k] - p[k]) * (r[k] - p[k]);
    }
    return dot / sqrt(fmax(qq * rr - dot * dot, 1e-300));
}

/* Whether the two angles opposite the edge add up to more than 180 degrees. */
static bool is_not_delaunay(const surface *s, uint32_t h) {
    return cotangent_at(s, h) + cotangent_at(s, s->twins[h]) < -1e-9;
}

static void flip_where(surface *s, bool (*wanted)(const surface *, uint32_t)) {
    for (uint32_t h = 0; h < s->mesh.triangle_count * 3; h++)
        if (!triangle_is_dead(s, h / 3) && h < s->twins[h] && wanted(s, h)) surface_flip(s, h);
}

/* Moves vertices along the surface towards the mean of their neighbours. */
static void relax_vertices(surface *s, const implicit *shape, double length) {
    for (uint32_t v = 0; v < s->mesh.vertex_count; v++) {
        if (s->out[v] == UINT32_MAX) continue;
        double sum[3] = {0.0, 0.0, 0.0}, count = 0.0;
        uint32_t h = s->out[v];
        do {
            const double *to = s->mesh.positions + (size_t)half_edge_to(s, h) * 3;
            for (int k = 0; k < 3; k++) sum[k] += to[k];
            count += 1.0;
            h = half_edge_turn(s, h);
        } while (h != s->out[v]);
        const double *p = s->mesh.positions + (size_t)v * 3;
        double normal[3], at[3], off = 0.0;
        surface_normal(s, v, normal);
        for (int k = 0; k < 3; k++) off += (sum[k] / count - p[k]) * normal[k];
        for (int k = 0; k < 3; k++) at[k] = sum[k] / count - off * normal[k];
        implicit_project(shape, length, at);
        surface_move(s, v, at);
    }
}

/* Returns the length of an edge when `count` equilateral triangles cover the same area. */
static double ideal_length(const surface *s, uint32_t count) {
    double sum = 0.0;
    for (uint32_t h = 0; h < s->mesh.triangle_count * 3; h++)
        if (!triangle_is_dead(s, h / 3)) sum += surface_squared_length(s, h);
    return sqrt(sum / 3.0 / count);
}

/* Collapses or splits edges until the target is reached; false when not enough edges can be collapsed. */
static bool reach_count(surface *s, const implicit *shape, uint32_t target, double length) {
    for (int pass = 0; pass < PASSES_MAX && s->live_triangles != target; pass++) {
        uint32_t most = s->live_triangles / 50 + 1;
        if (s->live_triangles > target) {
            uint32_t surplus = (s->live_triangles - target) / 2;
            collapse_shortest(s, shape, most < surplus ? most : surplus, length, INFINITY);
        } else {
            uint32_t missing = (target - s->live_triangles) / 2;
            split_longest(s, shape, most < missing ? most : missing, length, 0.0);
        }
        flip_where(s, evens_valences);
    }
    return s->live_triangles == target;
}

static bool even_out(surface *s, const implicit *shape, uint32_t target, int rounds) {
    for (int round = 0; round < rounds; round++) {
        double length = ideal_length(s, target);
        uint32_t most = s->live_triangles / 8;
        split_longest(s, shape, most, length, 4.0 / 3.0 * length);
        collapse_shortest(s, shape, most, length, 0.75 * length);
        if (!reach_count(s, shape, target, length)) return false;
        flip_where(s, evens_valences);
        relax_vertices(s, shape, length);
    }
    return true;
}

bool body_remesh(body *b, const implicit *shape, uint32_t triangle_count) {
    surface s;
    surface_open(&s, b);
    bool good = triangle_count % 2 == 0;
    while (good && s.live_triangles < triangle_count / 2) {
        good = even_out(&s, shape, s.live_triangles, 2);
        surface_quarter(&s);
    }
    good = good && even_out(&s, shape, triangle_count, EVEN_ROUNDS);
    double length = ideal_length(&s, triangle_count);
    for (int round = 0; good && round < FINAL_ROUNDS; round++) {
        flip_where(&s, is_not_delaunay);
        relax_vertices(&s, shape, length);
    }
    flip_where(&s, is_not_delaunay);
    surface_close(&s, b);
    return good;
}

bool body_add_even_implicit(body *b, const implicit *shape, uint32_t triangle_count) {
    body nets = {0};
    double spacing = 0.1;
    uint32_t wanted = triangle_count < NETS_LEAST ? NETS_LEAST : triangle_count;
    uint32_t most = shape->narrow ? NARROW_NETS_MOST : NETS_MOST;
    while (wanted > most) wanted = (wanted + 3) / 4;
    for (int i = 0; i < 3; i++) {
        body_free(&nets);
        double taken = body_add_implicit(&nets, shape, spacing);
        /* The spacing asked for was refused, because sheets met, and this one is fine enough. */
        if (taken < spacing && nets.triangle_count >= wanted) break;
        spacing *= sqrt((double)nets.triangle_count / wanted); /* remeshing makes the count exact */
    }
    bool good = body_remesh(&nets, shape, triangle_count);
    if (good) body_append(b, &nets, (double[3]){0.0, 0.0, 0.0});
    body_free(&nets);
    return good;
}
