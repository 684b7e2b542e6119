/* Trees that follow a motion: built when they are first needed, refitted, and rebuilt when they have decayed. */
#pragma once

#include "runtime/bvh/bvh.h"

/* The extent of leaves as a multiple of that of their triangles, and the extent of blocks of trees as a multiple of
 * that of their trees. */
typedef struct bvh_spread {
    double leaves, trees;
} bvh_spread;

/* The input that trees are built from, and how loose they have become since. */
typedef struct bvh_rebuild {
    const cscd_mesh *mesh;
    bvh_regions regions;
    int axis_count;
    const object_set *objects; /* the rules for objects, one for each; NULL: there are none */
    const bool *active;        /* per triangle; NULL: all are */

    bvh kept; /* trees that have moved over from another mesh and are finished when trees are needed; mesh NULL: none */
    bvh_spread spread_when_built;
    uint32_t intervals_unmeasured; /* intervals since the spread was last measured */
    uint32_t useless_rebuilds;     /* in a row, at most 4: each doubles the time to the next measurement */
    bool rebuilt;                  /* by the last call of bvh_rebuild_move */
} bvh_rebuild;

/* Builds the trees from x0 if there are none, or those that are missing from `kept`, and refits them to the interval from x0 to x1, with volumes widened by
 * growth.
 *
 * A refit keeps together what was near when the trees were built. So the spread is measured every 16th interval; where
 * it has grown by a quarter, the trees are rebuilt from x0. After a rebuild that was of no use the next measurement
 * waits twice as long. Spreads are compared with volumes that are widened by step_growth, whatever the growth.
 * All this depends on positions alone. Without memory for new trees the old ones stay. A mesh
 * without triangles has no trees. */
cscd_status bvh_rebuild_move(bvh_rebuild *r, bvh *hierarchy, const double *x0, const double *x1,
                             volume_growth growth, volume_growth step_growth);

/* Refits the trees to a moment, and builds them first if there are none. It measures nothing, because only intervals
 * count. */
cscd_status bvh_rebuild_move_to(bvh_rebuild *r, bvh *hierarchy, const double *positions, volume_growth growth,
                                volume_growth step_growth);
