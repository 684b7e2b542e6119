/* What is near on a mesh: the edges at each vertex, where vertices that seams unite are one, and how far rings reach. */
#pragma once

#include "src/mesh/mesh.h"

/* Two triangles are within k rings of each other if between their vertices lie at most k - 1 edges. Each triangle stamps
 * the vertices at most `radius` edges away from its own, and two of them are near if a vertex has the stamps of both or,
 * with `odd`, also if an edge has the stamp of one at one end and that of the other at the other end. With 0 rings,
 * triangles are stamped themselves. */
typedef struct mesh_rings {
    bool same;       /* 0 rings */
    uint32_t radius; /* with k rings (k - 1) / 2, */
    bool odd;        /* and k - 1 is odd */

    /* Unless `same`: */
    uint32_t *names;      /* per vertex: the least of those that it is one with */
    size_t *offsets;      /* per name: where its neighbours begin */
    uint32_t *neighbours; /* names at the other ends of edges */
} mesh_rings;

/* Seams are of existing vertices. OUT_OF_MEMORY has no sentence. */
cscd_status mesh_rings_create(const cscd_mesh *mesh, uint32_t rings, const uint32_t *seams, size_t seam_count,
                              mesh_rings *out);
void mesh_rings_free(cscd_context *context, mesh_rings *r);

/* What stands for a vertex that no triangle has: itself, or with `same` a number from the end on. */
static inline uint32_t element_of_loose(const mesh_rings *r, uint32_t vertex) {
    return r->same ? UINT32_MAX - vertex : r->names[vertex];
}
