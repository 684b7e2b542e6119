/* Meshes of slivers, or of large triangles. The boxes of slivers that lie side by side along a diagonal all overlap, so what tells them
 * apart is the hull of two boxes, one around their near ends and one around their far ends; in doubles, because large triangles may lie
 * on each other more closely than floats tell. */
#pragma once

#include "runtime/bvh/bvh.h"

/* Where the triangles below a child lie: each corner is in one of the two boxes. Not scaled. */
typedef struct sliver_volume {
    double boxes[2][2][2]
                [3]; /* near or far, at both ends of the interval: the least and the greatest coordinates */
    int axis;        /* far ends are the greater ones along this axis; -1: nothing is known */
} sliver_volume;

/* Are triangles of a farther than the distance from those of b, throughout the interval? */
bool sliver_volumes_apart(const sliver_volume *a, const sliver_volume *b, double distance);

/* Makes room for sliver volumes, as a step of bvh_build, where half of the triangles are slivers or large at these positions. False: no memory. */
bool bvh_allocate_slivers(bvh *hierarchy, const double *positions);

/* Frees them, as a step of bvh_free. */
void bvh_free_slivers(bvh *hierarchy);

/* Finds the volumes for the interval from x0 to x1, as a step of bvh_refit, after bvh_refit_hubs. */
void bvh_refit_slivers(bvh *hierarchy, const double *x0, const double *x1);
