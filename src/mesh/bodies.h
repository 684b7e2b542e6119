/* Bodies: the groups of components that winding numbers count as one. */
#pragma once

#include "src/mesh/mesh.h"

/* Without labels the objects are the bodies, and nothing is stored. */
typedef struct surface_bodies {
    uint32_t *components; /* per component: its body; NULL: the objects are the bodies */
    uint32_t *
        objects; /* per body: its object. Those of an object follow each other, in the order of the objects */
    uint32_t count;
} surface_bodies;

/* Two components of an object are one body if a part has triangles of both, or if other components of the object join them
 * so. A component of no part is a body of its own. False: no memory, and *out is untouched. */
bool bodies_find(const cscd_mesh *mesh, const uint32_t *labels, uint32_t part_count, surface_bodies *out);
bool bodies_copy(const surface_bodies *from, const cscd_mesh *mesh, surface_bodies *out);
void bodies_free(cscd_context *context, surface_bodies *b);

static inline uint32_t body_count(const surface_bodies *b, const cscd_mesh *mesh) {
    return b != NULL && b->components != NULL ? b->count : mesh->object_count;
}

static inline uint32_t body_of_triangle(const surface_bodies *b, const cscd_mesh *mesh, uint32_t triangle) {
    if (b != NULL && b->components != NULL) return b->components[mesh->triangle_components[triangle]];
    return cscd_mesh_vertex_object(mesh, mesh->triangles[triangle][0]);
}

static inline uint32_t object_of_body(const surface_bodies *b, uint32_t number) {
    return b != NULL && b->components != NULL ? b->objects[number] : number;
}
