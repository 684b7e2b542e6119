/* The calls of a solver share this: pairs of features that are near each other at one moment, and certified steps. */
#pragma once

#include "runtime/detector/detector.h"
#include "runtime/solver/free_step.h"

/* ---- near pairs ---------------------------------------------------------------------------------------- */

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

/* Makes room for the positions that a call reaches, d->reached. */
cscd_status solver_reserve_reached(cscd_detector *d);

/* ---- certified steps ----------------------------------------------------------------------------------- */

/* Finds the longest step of a motion that is certified free of contact, by the stages of a step. The motion's
 * positions have been checked. The positions that are reached are d->reached; timings and
 * counters are those of the whole search. The status is as in cscd_detector_max_step; with IN_CONTACT, too, *out is
 * written. */
cscd_status max_step_find(cscd_detector *d, const straight_motion *m, cscd_free_step *out);
