/* Closed walks along edges, smoothed: the contours between which a cut is chosen. */
#pragma once

#include "src/mesh/mesh.h"

/* Edges of a closed manifold component that form closed walks. */
typedef struct contour {
    const cscd_mesh *mesh;
    uint32_t count, *edges; /* its edges; while it is smoothed, also some that have left it */
    bool *on;               /* per edge: it is on the contour */
    bool *passed;           /* scratch, per triangle, false between calls */
    uint32_t *crossed;      /* scratch, per triangle */
} contour;

/* On failure *out holds nothing. */
cscd_status contour_create(const cscd_mesh *mesh, contour *out);
void contour_destroy(contour *c);

/* Empties the contour. */
void contour_clear(contour *c);

/* Adds an edge that is not on the contour yet. */
void contour_add(contour *c, uint32_t edge);

/* Where two sides of a triangle are on the contour it takes the third, which is shorter than both, until no triangle has two. It
 * passes over each triangle once at most. */
void contour_smooth(contour *c);

/* The sum of the lengths of its edges. */
double contour_length(const contour *c, const double *positions);
