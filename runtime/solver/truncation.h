/* Shortens the motion of each vertex, so that planes between near pairs keep these apart. */
#pragma once

#include "runtime/solver/near_pairs.h"

/* The motion that a caller wants, and the scalar in which each object's positions are stored. */
typedef struct wanted_motion {
    const double *x0, *x1;
    const cscd_scalar *scalars; /* per object; NULL: doubles */
} wanted_motion;

typedef struct truncation_outcome {
    double fraction;          /* the least share of its motion that a vertex goes */
    double obstacle_fraction; /* the same of the vertices of obstacles; 1 if there are none */
    uint32_t shortened;       /* the number of vertices that do not reach x1 */
    bool moved;               /* some vertex has left x0 */
    cscd_proximities
        held; /* pairs without a plane between them: their vertices stay; in the detector's memory */
} truncation_outcome;

/* Writes where the vertices go: docs/theory/displacement-bounds.md, lemmas 4 to 6, say what holds then. The vertices
 * of a seam go the same share. What
 * the detector knows of x0, it then knows of the end. */
cscd_status truncation_find(cscd_detector *d, const wanted_motion *motion, double search_radius, double *end,
                            truncation_outcome *out);
