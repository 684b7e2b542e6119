/* The elastic energy of displacements: masses, a Laplacian, its square for bending, and the pull of a rest shape. */
#include "runtime/untangle/untangle.h"

#include "src/core/vec3.h"

#include <math.h>

/* ---- bending --------------------------------------------------------------------------------------------- */

/* Bends of displacements at a vertex are bending^2 times their Laplacian; their squares are divided by the area. */

/* Writes the Laplacian at a vertex, times a factor. */
static void laplacian_at(const vertex_graph *g, const double *u, uint32_t v, double factor, double out[3]) {
    const double *uv = u + 3 * (size_t)v;
    for (int k = 0; k < 3; k++) out[k] = 0.0;
    for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++) {
        const double *un = u + 3 * (size_t)g->neighbours[n], coupling = factor * g->couplings[n];
        for (int k = 0; k < 3; k++) out[k] += coupling * (uv[k] - un[k]);
    }
}

static double bending_value(const untangle_work *w, double squared, const double *u) {
    double sum = 0.0;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        double bend[3];
        if (w->graph.names[v] != v) continue;
        laplacian_at(&w->graph, u, v, squared, bend);
        sum += vec3_dot(bend, bend) / w->graph.areas[v];
    }
    return 0.5 * sum;
}

static void add_bending_gradient(const untangle_work *w, double squared, const double *u, double *gradient) {
    const vertex_graph *g = &w->graph;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        double bend[3], *own = gradient + 3 * (size_t)v;
        if (g->names[v] != v) continue;
        laplacian_at(g, u, v, squared, bend);
        if (!g->fixed[v]) vec3_add_scaled(own, squared * g->coupled[v] / g->areas[v], bend, own);
        for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++) {
            double *at = gradient + 3 * (size_t)g->neighbours[n];
            if (!g->fixed[g->neighbours[n]])
                vec3_add_scaled(at, -squared * g->couplings[n] / g->areas[v], bend, at);
        }
    }
}

/* Adds the square of the bend at one vertex. False: no memory. */
static bool add_bend(untangle_work *w, double squared, uint32_t v) {
    const vertex_graph *g = &w->graph;
    const size_t first = g->begins[v], count = g->begins[v + 1] - first + 1;
    if (!block_system_reserve(&w->system, count * (count + 1) / 2)) return false;
    for (size_t a = 0; a < count; a++) { /* the last is v itself */
        const uint32_t row = w->region.rows[a + 1 < count ? g->neighbours[first + a] : v];
        const double of_row = squared * (a + 1 < count ? -g->couplings[first + a] : g->coupled[v]);
        for (size_t b = a; b < count && row != NO_ROW; b++) {
            const uint32_t column = w->region.rows[b + 1 < count ? g->neighbours[first + b] : v];
            const double of_column = squared * (b + 1 < count ? -g->couplings[first + b] : g->coupled[v]);
            const double twice = column == row && a != b ? 2.0 : 1.0;
            if (column != NO_ROW)
                block_system_add_scalar(&w->system, row, column, twice * of_row * of_column / g->areas[v]);
        }
    }
    return true;
}

static bool touches_region(const untangle_work *w, uint32_t v) {
    const vertex_graph *g = &w->graph;
    if (w->region.rows[v] != NO_ROW) return true;
    for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++) {
        if (w->region.rows[g->neighbours[n]] != NO_ROW) return true;
    }
    return false;
}

static bool add_bending(untangle_work *w, double squared) {
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        if (w->graph.names[v] == v && touches_region(w, v) && !add_bend(w, squared, v)) return false;
    }
    return true;
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

double elastic_value(const untangle_work *w, double spread, const double *u) {
    const vertex_graph *g = &w->graph;
    double of_masses = 0.0, of_edges = 0.0, of_rest = w->pull_energy;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        if (g->names[v] != v) continue;
        const double *uv = u + 3 * (size_t)v;
        of_masses += g->fixed[v] ? 0.0 : g->masses[v] * vec3_dot(uv, uv);
        if (w->pulls != NULL) of_rest += vec3_dot(w->pulls + 3 * (size_t)v, uv);
        for (size_t k = g->begins[v]; k < g->begins[v + 1]; k++) {
            if (g->neighbours[k] < v) continue;
            of_edges += g->couplings[k] * vec3_squared_distance(uv, u + 3 * (size_t)g->neighbours[k]);
        }
    }
    const double bending = w->options.bending;
    const double sum = 0.5 * (of_masses + spread * spread * of_edges) + spread * spread * of_rest;
    return bending > 0.0 ? sum + bending_value(w, bending * bending, u) : sum;
}

void elastic_gradient(const untangle_work *w, double spread, const double *u, double *gradient) {
    const vertex_graph *g = &w->graph;
    const double squared = spread * spread;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        double *out = gradient + 3 * (size_t)v;
        const double *uv = u + 3 * (size_t)v;
        for (int k = 0; k < 3; k++) out[k] = 0.0;
        if (g->names[v] != v || g->fixed[v]) continue;
        laplacian_at(g, u, v, 1.0, out);
        if (w->pulls != NULL) vec3_add_scaled(out, 1.0, w->pulls + 3 * (size_t)v, out);
        for (int k = 0; k < 3; k++) out[k] = squared * out[k] + g->masses[v] * uv[k];
    }
    const double bending = w->options.bending;
    if (bending > 0.0) add_bending_gradient(w, bending * bending, u, gradient);
}

bool elastic_add(untangle_work *w, double spread) {
    const vertex_graph *g = &w->graph;
    const vertex_region *r = &w->region;
    const double squared = spread * spread;
    size_t entries = r->count;
    for (uint32_t row = 0; row < r->count; row++)
        entries += g->begins[r->vertices[row] + 1] - g->begins[r->vertices[row]];
    if (!block_system_reserve(&w->system, entries)) return false;
    for (uint32_t row = 0; row < r->count; row++) {
        const uint32_t v = r->vertices[row];
        block_system_add_scalar(&w->system, row, row, g->masses[v] + squared * g->coupled[v]);
        for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++) {
            const uint32_t other = r->rows[g->neighbours[n]];
            if (other != NO_ROW && other > row)
                block_system_add_scalar(&w->system, row, other, -squared * g->couplings[n]);
        }
    }
    const double bending = w->options.bending;
    return !(bending > 0.0) || add_bending(w, bending * bending);
}

uint32_t elastic_rings(const untangle_work *w, double length) {
    static const double most = 400.0;
    return (uint32_t)min_of(ceil(length / w->graph.edge_length), most);
}
