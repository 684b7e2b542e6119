/* Parts of a scene: the labels of triangles, the bodies that parts make of components, and the parts of contacts. */
#pragma once

#include "src/mesh/mesh_change.h"

#include <cscd/surface.h>

/* ---- bodies ------------------------------------------------------------------------------------------------ */

/* The groups of components that winding numbers count as one. Without labels the objects are the bodies, and nothing is stored. */
typedef struct surface_bodies {
    uint32_t *components; /* per component: its body; NULL: the objects are the bodies */

    /* Per body: its object. Those of an object follow each other, in the order of the objects. */
    uint32_t *objects;

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

/* ---- parts ------------------------------------------------------------------------------------------------- */

/* The part that each triangle is in: its object, or what the caller says. */
typedef struct part_labels {
    uint32_t *triangles; /* a label each; NULL: the objects are the parts */
    uint32_t *sizes;     /* per part, the number of its triangles; behind them, of those in no part */
    uint32_t part_count;
    surface_bodies bodies; /* of these parts */
} part_labels;

/* INVALID_ARGUMENT: the sentence begins with `name`, or names the first triangle whose label is too large. */
cscd_status part_labels_check(const cscd_mesh *mesh, const uint32_t *labels, uint32_t part_count,
                              const char *name);

/* Takes checked labels in place of those before; NULL: none. OUT_OF_MEMORY: nothing has changed, and there is no
 * sentence. */
cscd_status part_labels_set(const cscd_mesh *mesh, const uint32_t *labels, uint32_t part_count,
                            part_labels *p);

/* mesh: the same one in the context of the copy, or the new one of a change. On failure *out is untouched. */
cscd_status part_labels_copy(const part_labels *p, const cscd_mesh *mesh, part_labels *out);
cscd_status part_labels_move(const part_labels *p, const cscd_mesh *mesh, const cscd_mesh_change *change,
                             part_labels *out);
void part_labels_free(cscd_context *context, part_labels *p);

/* Returns the first fault as a sentence, or NULL. */
const char *part_labels_validate(const part_labels *p, const cscd_mesh *mesh);

/* The number of triangles of a part, or of none. */
uint32_t part_size(const part_labels *p, const cscd_mesh *mesh, uint32_t part);

/* The part of a feature; UINT32_MAX: none. */
uint32_t part_of_triangle(const part_labels *p, const cscd_mesh *mesh, uint32_t triangle);
uint32_t part_of_vertex(const part_labels *p, const cscd_mesh *mesh, uint32_t vertex);
uint32_t part_of_edge(const part_labels *p, const cscd_mesh *mesh, uint32_t edge);

/* Tells whether the point of a depth lies within another body than its own. Where its patch is not known, others of that patch
 * say so. */
static inline bool depth_is_in_other_body(const cscd_intersections *found, const cscd_depth *depth) {
    return found->patches != NULL && depth->patch != UINT32_MAX &&
           found->patches->items[depth->patch].body != depth->body;
}

/* The key of two parts: the smaller one in the upper half. */
static inline uint64_t key_of_parts(uint32_t p, uint32_t q) {
    return p < q ? (uint64_t)p << 32 | q : (uint64_t)q << 32 | p;
}

/* ---- contacts that a caller gives back --------------------------------------------------------------------- */

/* Checks that all features are of the mesh. INVALID_ARGUMENT names the contact; function is the name of the API's. */
cscd_status given_contacts_check(cscd_context *context, const cscd_mesh *mesh, const char *function,
                                 const cscd_contact *contacts, size_t count);

/* The key of the parts that the two features of a contact are in. */
uint64_t parts_of_contact(const part_labels *labels, const cscd_mesh *mesh, cscd_contact_kind kind,
                          uint32_t a, uint32_t b);
