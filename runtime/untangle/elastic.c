/* The elastic energy of displacements. */
#include "runtime/untangle/untangle.h"

#include "src/core/vec3.h"

#include <math.h>

double elastic_value(const untangle_work *w, double spread, const double *u) {
    const vertex_graph *g = &w->graph;
    double of_masses = 0.0, of_edges = 0.0;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        if (g->names[v] != v) continue;
        const double *uv = u + 3 * (size_t)v;
        of_masses += g->fixed[v] ? 0.0 : g->masses[v] * vec3_dot(uv, uv);
        for (size_t k = g->begins[v]; k < g->begins[v + 1]; k++) {
            if (g->neighbours[k] < v) continue;
            of_edges += g->couplings[k] * vec3_squared_distance(uv, u + 3 * (size_t)g->neighbours[k]);
        }
    }
    return 0.5 * (of_masses + spread * spread * of_edges);
}

void elastic_gradient(const untangle_work *w, double spread, const double *u, double *gradient) {
    const vertex_graph *g = &w->graph;
    const double squared = spread * spread;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        double *out = gradient + 3 * (size_t)v;
        const double *uv = u + 3 * (size_t)v;
        for (int k = 0; k < 3; k++) out[k] = 0.0;
        if (g->names[v] != v || g->fixed[v]) continue;
        for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++) {
            const double *un = u + 3 * (size_t)g->neighbours[n];
            for (int k = 0; k < 3; k++) out[k] += g->couplings[n] * (uv[k] - un[k]);
        }
        for (int k = 0; k < 3; k++) out[k] = squared * out[k] + g->masses[v] * uv[k];
    }
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
    return true;
}

uint32_t elastic_rings(const untangle_work *w, double length) {
    static const double most = 400.0;
    return (uint32_t)min_of(ceil(length / w->graph.edge_length), most);
}
