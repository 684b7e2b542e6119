/* Pairs of features that are near each other at one moment. */
#pragma once

#include "runtime/detector/detector.h"
#include "runtime/detector/interval_search.h"
#include "runtime/narrow_phase/narrow_phase.h"

/* Returns INVALID_ARGUMENT, with a sentence, unless this is a distance that can be asked for. */
cscd_status proximity_check_distance(cscd_context *context, double distance);

/* The same for a form of the list. */
cscd_status proximity_check_form(cscd_context *context, cscd_near_form form);

/* Begins a search of the moment with that limit. */
interval_search proximity_search(cscd_detector *d, const double *positions, double distance);

/* Lists what the search has found, in the detector's memory, sorted by (kind, a, b). */
cscd_status proximity_collect(cscd_detector *d, const double *positions, cscd_near_form form,
                              cscd_proximities *out);

/* Finds all pairs within the distance and lists them so. The positions have been checked. */
cscd_status proximity_find(cscd_detector *d, const double *positions, double distance, cscd_near_form form,
                           cscd_proximities *out);
