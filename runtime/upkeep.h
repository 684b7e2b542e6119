/* The detector's trees: built when they are first needed, moved, and built anew when they have decayed. */
#ifndef CSCD_UPKEEP_H
#define CSCD_UPKEEP_H

#include "runtime/detector.h"

/* Moves the forest, built from x0 if there is none, on to the interval from x0 to x1; the same array twice:
 * to a moment. Every 16th interval its leaves are looked at: a refit keeps triangles together that were near
 * when the trees were built, and when leaves have grown by a quarter beyond their triangles, the trees are
 * built anew from x0. That depends on positions alone. */
cscd_status upkeep_move(cscd_detector *d, const double *x0, const double *x1, double distance);

/* How much farther leaves extend than the triangles in them, on average, at the interval's start. */
double upkeep_spread(const forest *f);

#endif
