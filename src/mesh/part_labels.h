/* Which part of a scene each triangle is in: objects, or what the caller says. */
#pragma once

#include "src/mesh/bodies.h"
#include "src/mesh/mesh_change.h"

#include <cscd/surface.h>

typedef struct part_labels {
    uint32_t *triangles; /* a label each; NULL: the objects are the parts */
    uint32_t *sizes;     /* per part: so many triangles; behind them, of no part */
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

/* Does the point of a depth lie within another body than its own? Where its patch is not known, others of that patch say so. */
static inline bool depth_is_in_other_body(const cscd_intersections *found, const cscd_depth *depth) {
    return found->patches != NULL && depth->patch != UINT32_MAX &&
           found->patches->items[depth->patch].body != depth->body;
}

/* The key of two parts: the smaller one in the upper half. */
static inline uint64_t key_of_parts(uint32_t p, uint32_t q) {
    return p < q ? (uint64_t)p << 32 | q : (uint64_t)q << 32 | p;
}
