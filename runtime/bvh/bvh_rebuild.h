/* The detector's trees: built when they are first needed, moved, and built anew when they have decayed. */
#pragma once

#include "runtime/detector/detector.h"

/* Moves the BVH, built from x0 if there is none, on to the interval from x0 to x1.
 *
 * A refit keeps together what was near when the trees were built. Every 16th interval the extents of leaves
 * are compared with those of their triangles, and those of blocks of parts with those of their parts; where
 * one or the other has grown by a quarter, the trees are built anew from x0. Where that was of no use the
 * next look waits twice as long. Volumes are compared as wide as those of steps, whatever the distance asked
 * for. All this depends on positions alone. */
cscd_status upkeep_move(cscd_detector *d, const double *x0, const double *x1, double distance);

/* To a moment. */
cscd_status upkeep_move_to(cscd_detector *d, const double *positions, double distance);
