/* The shortest cut through a band of triangles: a minimum cut of the dual graph. */
#include "preprocess/regions/cut.h"

cscd_status cutter_create(const cscd_mesh *mesh, const dual_graph *graph, const int64_t *capacities,
                          cutter *out) {
    const flow_graph flow = {mesh->triangle_count, graph->link_count, graph->offsets, graph->neighbours,
                             graph->twins};
    *out = (cutter){.graph = graph, .capacities = capacities};
    return min_cut_create(mesh->context, &flow, &out->cut);
}

void cutter_destroy(cutter *c) {
    min_cut_destroy(&c->cut);
}

/* Turns capacities to the parts into supplies and drains. */
static void set_supplies(cutter *c, const uint32_t *parts, const uint32_t *band, uint32_t band_size,
                         uint32_t part) {
    for (uint32_t i = 0; i < band_size; i++) {
        const uint32_t t = band[i];
        c->cut.supplies[t] = c->cut.drains[t] = 0;
        for (uint32_t j = c->graph->offsets[t]; j < c->graph->offsets[t + 1]; j++) {
            const uint32_t other = parts[c->graph->neighbours[j]];
            c->cut.residuals[j] = other == 0 ? c->capacities[j] : 0;
            if (other == part) c->cut.supplies[t] += c->capacities[j];
            if (other != 0 && other != part) c->cut.drains[t] += c->capacities[j];
        }
    }
}

uint32_t cutter_separate(cutter *c, const uint32_t *parts, const uint32_t *band, uint32_t band_size,
                         uint32_t part, uint32_t *out) {
    set_supplies(c, parts, band, band_size, part);
    const uint32_t reached = min_cut_run(&c->cut, band, band_size);
    for (uint32_t i = 0; i < reached; i++) out[i] = c->cut.queue[i];
    return reached;
}
