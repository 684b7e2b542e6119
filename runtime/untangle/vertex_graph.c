/* Unknowns of a mesh, and regions of them. */
#include "runtime/untangle/vertex_graph.h"

#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

static array_list list_arrays(vertex_graph *g) {
    const size_t n = g->mesh->vertex_count, pairs = 2 * (size_t)g->mesh->edge_count;
    return (array_list){{ARRAY(g->names, n), ARRAY(g->fixed, n), ARRAY(g->begins, n + 1),
                         ARRAY(g->neighbours, pairs), ARRAY(g->couplings, pairs), ARRAY(g->areas, n),
                         ARRAY(g->masses, n), ARRAY(g->coupled, n)}};
}

void vertex_graph_free(vertex_graph *g) {
    if (g->context != NULL) context_free_all(g->context, list_arrays(g));
}

/* ---- what moves ---------------------------------------------------------------------------------------- */

static void fix_vertices(vertex_graph *g, const graph_source *from) {
    const cscd_mesh *mesh = g->mesh;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t first = mesh->vertex_star_offsets[v];
        const bool lone = first == mesh->vertex_star_offsets[v + 1];
        g->names[v] = from->names != NULL ? from->names[v] : v;
        g->fixed[v] = lone || triangle_of_obstacle(mesh, mesh->vertex_stars[first]) ||
                      (from->movable != NULL && !from->movable[v]) ||
                      (from->weights != NULL && isinf(from->weights[v]));
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (g->fixed[v]) g->fixed[g->names[v]] = true;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) g->fixed[v] = g->fixed[g->names[v]];
}

/* ---- the Laplacian ------------------------------------------------------------------------------------- */

/* Half a cotangent, within bounds: thin triangles must not make a row negative, or far larger than others. */
static const double least_coupling = 0.05, largest_coupling = 5.0;

/* The cross product of two sides, which are measured in the unit: areas of the largest and smallest meshes are numbers, too. */
static void cross_sides(double unit, const double *at, const double *a, const double *b, double u[3],
                        double v[3], double across[3]) {
    vec3_subtract(a, at, u);
    vec3_subtract(b, at, v);
    for (int k = 0; k < 3; k++) {
        u[k] /= unit;
        v[k] /= unit;
    }
    vec3_cross(u, v, across);
}

static double half_cotangent(double unit, const double *at, const double *a, const double *b) {
    double u[3], v[3], across[3];
    cross_sides(unit, at, a, b, u, v, across);
    const double area = sqrt(vec3_dot(across, across));
    const double half = area > 0.0 ? 0.5 * vec3_dot(u, v) / area : largest_coupling;
    return max_of(least_coupling, min_of(half, largest_coupling));
}

static double area_of(double unit, const double *a, const double *b, const double *c) {
    double u[3], v[3], across[3];
    cross_sides(unit, a, b, c, u, v, across);
    return 0.5 * sqrt(vec3_dot(across, across));
}

static double mean_length(const vertex_graph *g, const double *x) {
    const cscd_mesh *mesh = g->mesh;
    double sum = 0.0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *ends = mesh->edges[e];
        sum += sqrt(vec3_squared_distance(x + 3 * (size_t)ends[0], x + 3 * (size_t)ends[1]));
    }
    return mesh->edge_count > 0 ? sum / mesh->edge_count : 0.0;
}

/* A power of two near the length, so that dividing by it rounds nothing. */
static double unit_of_length(double length) {
    int exponent = 1;
    (void)frexp(length, &exponent);
    return ldexp(1.0, exponent - 1);
}

/* Areas, and couplings of the mesh's edges, both in the unit. Returns the whole area. */
static double add_triangles(vertex_graph *g, const double *x, double *of_edges) {
    const double unit = unit_of_length(g->edge_length);
    const cscd_mesh *mesh = g->mesh;
    double sum = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->triangles[t];
        const double *p[3];
        for (int k = 0; k < 3; k++) p[k] = x + 3 * (size_t)corners[k];
        const double area = area_of(unit, p[0], p[1], p[2]);
        sum += area;
        for (int k = 0; k < 3; k++) {
            g->areas[g->names[corners[k]]] += area / 3.0;
            of_edges[mesh->triangle_edges[t][k]] +=
                half_cotangent(unit, p[(k + 2) % 3], p[k], p[(k + 1) % 3]) / (unit * unit);
        }
    }
    return sum;
}

/* Weights beyond these are taken as these: their products with stiffnesses must be numbers, and sums of both more than rounding. */
static const double least_weight = 1e-12, largest_weight = 1e12;

/* A vertex of triangles without area has a thousandth of the mean area; 1, where nothing has any. */
static void weigh_vertices(vertex_graph *g, double area, const double *weights) {
    const uint32_t n = g->mesh->vertex_count;
    const double least = n > 0 && area > 0.0 ? 1e-3 * area / n : 1.0;
    for (uint32_t v = 0; v < n; v++) {
        if (g->names[v] != v) continue;
        g->masses[v] = g->areas[v] = max_of(g->areas[v], least);
        if (weights != NULL && !g->fixed[v])
            g->masses[v] *= max_of(least_weight, min_of(weights[v], largest_weight));
    }
    for (uint32_t v = 0; v < n; v++) {
        g->areas[v] = g->areas[g->names[v]];
        g->masses[v] = g->masses[g->names[v]];
    }
}

static bool joins_unknowns(const vertex_graph *g, uint32_t edge) {
    const uint32_t *ends = g->mesh->edges[edge];
    return g->names[ends[0]] != g->names[ends[1]];
}

static void list_neighbours(vertex_graph *g, const double *of_edges) {
    const cscd_mesh *mesh = g->mesh;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        for (int k = 0; k < 2 && joins_unknowns(g, e); k++) g->begins[g->names[mesh->edges[e][k]] + 1]++;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) g->begins[v + 1] += g->begins[v];
    for (uint32_t e = mesh->edge_count; e-- > 0;) {
        for (int k = 0; k < 2 && joins_unknowns(g, e); k++) {
            const uint32_t v = g->names[mesh->edges[e][k]];
            const size_t at = --g->begins[v + 1];
            g->neighbours[at] = g->names[mesh->edges[e][1 - k]];
            g->couplings[at] = of_edges[e];
            g->coupled[v] += of_edges[e];
        }
    }
    /* begins[v + 1] is now where the range of v begins */
    for (uint32_t v = 0; v < mesh->vertex_count; v++) g->begins[v] = g->begins[v + 1];
    size_t total = 0;
    for (uint32_t e = 0; e < mesh->edge_count; e++) total += joins_unknowns(g, e) ? 2 : 0;
    g->begins[mesh->vertex_count] = total;
}

cscd_status vertex_graph_make(vertex_graph *g, cscd_context *context, const cscd_mesh *mesh,
                              const graph_source *from) {
    *g = (vertex_graph){.context = context, .mesh = mesh};
    double *of_edges = context_allocate(context, mesh->edge_count, sizeof *of_edges);
    if (of_edges == NULL || !context_allocate_all(context, list_arrays(g))) {
        context_free(context, of_edges);
        *g = (vertex_graph){.context = NULL};
        return context_out_of_memory(context);
    }
    fix_vertices(g, from);
    g->edge_length = mean_length(g, from->positions);
    const double area = add_triangles(g, from->rest != NULL ? from->rest : from->positions, of_edges);
    weigh_vertices(g, area, from->weights);
    list_neighbours(g, of_edges);
    context_free(context, of_edges);
    return CSCD_OK;
}

/* ---- regions ------------------------------------------------------------------------------------------- */

static array_list region_arrays(vertex_region *r, size_t count) {
    return (array_list){{ARRAY(r->rows, count), ARRAY(r->vertices, count)}};
}

bool vertex_region_make(vertex_region *r, const vertex_graph *g) {
    const uint32_t n = g->mesh->vertex_count;
    r->count = 0;
    if (!context_reserve_all(g->context, region_arrays(r, n))) return false;
    for (uint32_t v = 0; v < n; v++) r->rows[v] = NO_ROW;
    return true;
}

void vertex_region_free(vertex_region *r, cscd_context *context) {
    context_free_all(context, region_arrays(r, 0));
}

void vertex_region_clear(vertex_region *r) {
    for (uint32_t i = 0; i < r->count; i++) r->rows[r->vertices[i]] = NO_ROW;
    r->count = 0;
}

void vertex_region_add(vertex_region *r, const vertex_graph *g, uint32_t vertex) {
    const uint32_t v = g->names[vertex];
    if (g->fixed[v] || r->rows[v] != NO_ROW) return;
    r->rows[v] = r->count;
    r->vertices[r->count++] = v;
}

void vertex_region_grow(vertex_region *r, const vertex_graph *g, uint32_t rings) {
    uint32_t first = 0;
    for (uint32_t ring = 0; ring < rings && first < r->count; ring++) {
        const uint32_t end = r->count;
        for (uint32_t i = first; i < end; i++) {
            const uint32_t v = r->vertices[i];
            for (size_t k = g->begins[v]; k < g->begins[v + 1]; k++)
                vertex_region_add(r, g, g->neighbours[k]);
        }
        first = end;
    }
}
