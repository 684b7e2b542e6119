/* How often the surfaces of bodies wind around a point of the mesh, under the same symbolic perturbation as the
 * intersection curves. */
#pragma once

#include "runtime/bvh/bvh_query.h"
#include "runtime/intersections/curve_piece.h"

/* A point infinitely near to a corner of a triangle: from the corner along one of its edges, then, infinitely less, into the
 * triangle and, infinitely less, off it to its outer side: that of its normal, unless its component is turned around. */
typedef struct corner_side {
    uint32_t triangle;
    uint8_t corner; /* 0 to 2 */
    bool next;      /* the edge leads to the next corner, else to the one before */
} corner_side;

/* Numbers of bodies, or of components. Those that are not 0 belong to touched bodies, each of them listed once. */
typedef struct winding_tally {
    int32_t *numbers;  /* per body */
    bool *is_touched;  /* the same */
    uint32_t *touched; /* room for all bodies */
    uint32_t count;
} winding_tally;

void winding_tally_clear(winding_tally *tally);

/* Has the triangle two corners of one name? Then nothing is to its sides. */
bool winding_is_collapsed(const named_surface *s, uint32_t triangle);

/* Adds the winding numbers of all bodies at the point, none at a collapsed triangle: of a body the sum over its closed manifold
 * components. A body winds once around what its surfaces, with normals outwards, enclose. Those of components that are turned
 * around count as turned. The bounds of the trees are those of the surface's positions. Theory: docs/theory/curves.md, lemma 5. */
void winding_find(const named_surface *s, const bvh *f, corner_side at, winding_tally *tally);

/* The same of each component, in a tally that has room for all components. */
void winding_find_by_component(const named_surface *s, const bvh *f, corner_side at, winding_tally *tally);
