/* Whole arrays of the public API: features of a mesh as they are stored, and the stencils of a list. */
#include "src/core/float_environment.h"
#include "src/mesh/mesh.h"
#include "src/mesh/stencil.h"

#include <string.h>

const uint32_t *cscd_mesh_all_triangles(const cscd_mesh *mesh) {
    return mesh->triangles[0];
}

const uint32_t *cscd_mesh_all_edges(const cscd_mesh *mesh) {
    return mesh->edges[0];
}

const uint32_t *cscd_mesh_all_triangle_edges(const cscd_mesh *mesh) {
    return mesh->triangle_edges[0];
}

void cscd_contact_stencils(const cscd_contact *items, size_t count, uint32_t *vertices, double *weights) {
    float_environment host = float_environment_begin();
    for (size_t i = 0; i < count; i++) {
        if (vertices != NULL) memcpy(vertices + 4 * i, items[i].vertices, sizeof items[i].vertices);
        if (weights != NULL) stencil_weights(items[i].kind, items[i].u, items[i].v, weights + 4 * i);
    }
    float_environment_set(host);
}

void cscd_proximity_stencils(const cscd_proximity *items, size_t count, uint32_t *vertices, double *weights) {
    for (size_t i = 0; i < count; i++) {
        if (vertices != NULL) memcpy(vertices + 4 * i, items[i].vertices, sizeof items[i].vertices);
        if (weights != NULL) memcpy(weights + 4 * i, items[i].weights, sizeof items[i].weights);
    }
}
