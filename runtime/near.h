/* Pairs of features that are near each other at one moment. */
#ifndef CSCD_NEAR_H
#define CSCD_NEAR_H

#include "runtime/interval_search.h"

/* Is this a distance that can be asked for? INVALID_ARGUMENT says why not. */
cscd_status near_check_distance(cscd_context *context, double distance);

/* The limit under which a search of the interval from positions to the same positions finds them. */
separation near_limit(double distance);

/* Of that search, in the detector's buffer. */
cscd_status near_collect(cscd_detector *d, const double *positions, cscd_proximities *out);

#endif
