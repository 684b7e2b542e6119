/* Whole arrays of the public API: features of a mesh as they are stored. */
#include "src/mesh/mesh.h"

const uint32_t *cscd_mesh_all_triangles(const cscd_mesh *mesh) {
    return mesh->triangles[0];
}

const uint32_t *cscd_mesh_all_edges(const cscd_mesh *mesh) {
    return mesh->edges[0];
}

const uint32_t *cscd_mesh_all_triangle_edges(const cscd_mesh *mesh) {
    return mesh->triangle_edges[0];
}
