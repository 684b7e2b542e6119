/* Orphan pairs where each edge has two triangles, by the few features that can be one. */
#pragma once

#include "runtime/narrow_phase/orphan_search.h"

/* Fills in f->even: the edges of which this search finds the pairs with one another. uneven: of vertices, those of triangles
 * that have another edge. f->opposites is known. */
void orphan_edges_mark(const orphan_search *f, bool *uneven);

/* Is a triangle near an edge that is not even, so that all of its pairs with adjacent triangles have to be looked at? */
static inline bool orphan_edges_near(const cscd_mesh *mesh, const bool *uneven, uint32_t t) {
    const uint32_t *v = mesh->triangles[t];
    return uneven[v[0]] || uneven[v[1]] || uneven[v[2]];
}

/* Adds the pairs of even edges with one another, for the edges whose stars begin with a triangle. */
void orphan_edges_of(orphan_search *f, uint32_t t);

/* Adds the pairs of the vertices whose stars begin with a triangle that is not near an uneven edge. */
void orphan_edges_vertices(orphan_search *f, uint32_t t);
