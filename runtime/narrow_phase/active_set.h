/* Which vertices may move in the next motions. Pairs of two features without any of them are not looked for. */
#pragma once

#include "src/mesh/mesh_change.h"

typedef struct active_set {
    bool *vertices;  /* NULL: all are active, and so is everything */
    bool *triangles; /* whether one of their vertices is active */
} active_set;

/* Makes room for a set, unless there is one. OUT_OF_MEMORY: nothing has changed. */
cscd_status active_set_reserve(const cscd_mesh *mesh, active_set *s);

/* Makes these vertices, which are of the mesh, and no others active. There is room. */
void active_set_fill(const cscd_mesh *mesh, const uint32_t *vertices, size_t count, active_set *s);

/* Copies all of it; mesh: the same one in the context of the copy. Here and below *out is untouched on failure. */
cscd_status active_set_copy(const active_set *s, const cscd_mesh *mesh, active_set *out);

/* The set of a mesh that was made from another one; mesh: the new one. What comes from an active vertex is active, and
 * so is what is new. */
cscd_status active_set_move(const active_set *s, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            active_set *out);
void active_set_free(cscd_context *context, active_set *s);

/* Returns the first fault as a sentence, or NULL. */
const char *active_set_validate(const active_set *s, const cscd_mesh *mesh);

static inline bool edge_is_active(const active_set *s, const cscd_mesh *mesh, uint32_t edge) {
    return s->vertices[mesh->edges[edge][0]] || s->vertices[mesh->edges[edge][1]];
}

/* Bit i: corner i of the triangle is active. */
static inline uint32_t active_corners(const active_set *s, const uint32_t corners[3]) {
    return (uint32_t)s->vertices[corners[0]] | (uint32_t)s->vertices[corners[1]] << 1 |
           (uint32_t)s->vertices[corners[2]] << 2;
}
