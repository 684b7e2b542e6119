/* Which triangle answers for a feature, so that each pair of features is tested once. */
#include "runtime/narrow_phase/representatives.h"

cscd_status representatives_create(const cscd_mesh *mesh, representatives *out) {
    cscd_context *context = mesh->context;
    representatives r = {.owned = context_allocate(context, mesh->triangle_count, sizeof *r.owned),
                         .others = context_allocate(context, mesh->vertex_count, sizeof *r.others),
                         .opposite = context_allocate(context, mesh->edge_count, sizeof *r.opposite)};
    if (r.owned == NULL || r.others == NULL || r.opposite == NULL) {
        representatives_free(context, &r);
        return CSCD_OUT_OF_MEMORY;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++) {
            const uint32_t *corners = mesh->triangles[t];
            uint32_t vertex = corners[i], edge = mesh->triangle_edges[t][i];
            bool first_at_vertex = mesh->vertex_stars[mesh->vertex_star_offsets[vertex]] == t;
            bool first_at_edge = mesh->edge_stars[mesh->edge_star_offsets[edge]] == t;
            r.owned[t] |= (uint8_t)(first_at_vertex << i | first_at_edge << (3 + i));
            for (int k = 0; first_at_vertex && k < 2; k++) r.others[vertex][k] = corners[(i + 1 + k) % 3];
            if (first_at_edge) r.opposite[edge] = corners[(i + 2) % 3];
        }
    }
    *out = r;
    return CSCD_OK;
}

void representatives_free(cscd_context *context, representatives *r) {
    context_free(context, r->owned);
    context_free(context, r->others);
    context_free(context, r->opposite);
    *r = (representatives){.owned = NULL};
}
