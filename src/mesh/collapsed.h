/* Which components have no surface at a moment, because all of their triangles have no area: hidden by a scale of 0, or
 * squashed to a line. */
#pragma once

#include "src/mesh/mesh.h"

typedef struct collapsed_components {
    const cscd_mesh *mesh;
    /* Per component one of its triangles, the last that was seen to have an area: as long as it has one, no other is
     * looked at. */
    uint32_t *witnesses;

    uint8_t *seen;  /* per component, while moments are looked at */
    bool *marks;    /* per component: it is collapsed at one of the moments that were added */
    uint32_t count; /* of marks that are set */
    uint32_t *list; /* the marked components, as collapsed_list has written them */
} collapsed_components;

/* On failure *out holds nothing. */
cscd_status collapsed_create(const cscd_mesh *mesh, collapsed_components *out);
void collapsed_free(collapsed_components *c);

/* Forgets all moments. */
void collapsed_begin(collapsed_components *c);

/* Marks the components that are collapsed at the positions, too. A wire of triangles each of which has two vertices of one
 * name is none of them: it never had a surface. names: per vertex; NULL: each has its own. Exact. */
void collapsed_add(collapsed_components *c, const double *positions, const uint32_t *names);

/* The marked components, ascending, `count` of them; NULL: none is marked. They live until marks change. */
const uint32_t *collapsed_list(collapsed_components *c);

/* Per component; NULL: none is marked. */
static inline const bool *collapsed_marks(const collapsed_components *c) {
    return c->count > 0 ? c->marks : NULL;
}
