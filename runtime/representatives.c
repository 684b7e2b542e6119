/* Which triangle answers for a feature, so that each pair of features is tested once. */
#include "runtime/representatives.h"

uint8_t *representatives_create(const cscd_mesh *mesh) {
    uint8_t *owned = context_allocate(mesh->context, mesh->triangle_count, sizeof *owned);
    if (owned == NULL) return NULL;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++) {
            uint32_t vertex = mesh->triangles[t][i], edge = mesh->triangle_edges[t][i];
            bool first_at_vertex = mesh->vertex_stars[mesh->vertex_star_offsets[vertex]] == t;
            bool first_at_edge = mesh->edge_stars[mesh->edge_star_offsets[edge]] == t;
            owned[t] |= (uint8_t)(first_at_vertex << i | first_at_edge << (3 + i));
        }
    }
    return owned;
}
