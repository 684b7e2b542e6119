/* Shortens the motion of each vertex, so that planes between near pairs keep these apart. */
#pragma once

#include "runtime/solver/near_pairs.h"

/* The motion that a caller wants, and the scalar in which each object's positions are stored. */
typedef struct wanted_motion {
    const double *x0, *x1;
    const cscd_scalar *scalars; /* per object; NULL: doubles */
} wanted_motion;

/* Writes where the vertices go: docs/theory/displacement-bounds.md, lemmas 4 to 6, say what holds then. The vertices of a
 * seam go the same share. What the detector knows of x0, it then knows of the end. */
cscd_status truncation_find(cscd_detector *d, const wanted_motion *motion, double search_radius, double *end,
                            cscd_truncation *out);
