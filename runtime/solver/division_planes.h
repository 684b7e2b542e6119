/* Planes that divide the space between near pairs, and how far each vertex may go towards them. */
#pragma once

#include "runtime/solver/near_pairs.h"

/* Ends a list of limits. */
#define DIVISION_NONE SIZE_MAX

/* A pair, and the plane between its features. A vertex, the i-th of the pair, may go by room[i] along sign * normal,
 * where the sign is that of division_sign. */
typedef struct division_plane {
    double normal
        [3]; /* from b to a; 0: no plane divides the pair, and its vertices stay. That of a half-space has
                       * a length from 1 to 4, in which room counts */
    double room[4]; /* -1 if they stay */
    size_t next[4]; /* the next limit of the same vertex: 4 * pair + place */
    uint32_t vertices[4];
    cscd_contact_kind kind;
} division_plane;

/* Vertices of a, which lies above the plane, are limited downwards. */
static inline double division_sign(const division_plane *plane, int place) {
    return place < points_of_first(stencil_points(plane->kind)) ? -1.0 : 1.0;
}

typedef struct division_planes {
    division_plane *planes; /* one per near pair, in the detector's scratch memory */
    size_t count;
    size_t *first; /* per vertex: its first limit */
} division_planes;

/* Divides the space between all pairs, for vertices that want to move from x0 to x1 and may go `farthest` at most. A pair that is farther apart than
 * its separation shares what is between: an obstacle takes what it needs, and else both sides get in proportion to what
 * they need. A pair that is not comes no nearer. `first` has room for all vertices. */
cscd_status division_planes_find(cscd_detector *d, const double *x0, const double *x1, double farthest,
                                 const cscd_proximities *near, size_t *first, division_planes *out);
