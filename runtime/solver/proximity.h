/* Pairs of features that are near each other at one moment. */
#pragma once

#include "runtime/detector/interval_search.h"

/* Is this a distance that can be asked for? INVALID_ARGUMENT says why not. */
cscd_status proximity_check_distance(cscd_context *context, double distance);

/* Within this distance pairs are reported; between that and the tolerance beyond it they may be. */
separation proximity_limit(double distance);

/* A search of that moment, begun. */
interval_search proximity_search(cscd_detector *d, const double *positions, double distance);

/* Of that search, in the detector's buffer. */
cscd_status proximity_collect(cscd_detector *d, const double *positions, cscd_proximities *out);
