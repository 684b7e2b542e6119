/* Open edges that all but lie on each other, as rounding leaves them between triangles that bring vertices of their own. */
#pragma once

#include <cscd/detector.h>

#include <stdbool.h>
#include <stdint.h>

typedef struct near_seams {
    uint32_t open_edges;   /* of the object */
    uint32_t joined_edges; /* of these: so many would be joined with others */
    double gap;            /* their corners lie so far apart at most */
    double distance;       /* by --weld with this distance, which has two digits at most */
} near_seams;

/* Looks at an object of the mesh, whose vertices have these positions: open edges whose corners lie within 1e-5 of its size of those of
 * another one. False: there are none, or not enough memory to find them. */
bool near_seams_find(const cscd_mesh *mesh, uint32_t object, const double *positions, near_seams *out);
