/* Pairs of features that are near each other at one moment. */
#ifndef CSCD_NEAR_H
#define CSCD_NEAR_H

#include "runtime/interval_search.h"

/* Is this a distance that can be asked for? INVALID_ARGUMENT names the argument and says why not. */
cscd_status near_check_distance(cscd_context *context, double distance, const char *name);

/* A search of that moment, begun. */
interval_search near_search(cscd_detector *d, const double *positions, double distance);

/* Of that search, in the detector's buffer. */
cscd_status near_collect(cscd_detector *d, const double *positions, cscd_proximities *out);

#endif
