/* The longest step towards x1 that is certified free of contact, by the stages of a step. */
#pragma once

#include "runtime/solver/free_step.h"

/* Searches a motion whose positions have been checked. The positions that are reached are d->reached; timings and
 * counters are those of the whole search. The status is as in cscd_detector_max_step; with IN_CONTACT, too, *out is
 * written. */
cscd_status max_step_find(cscd_detector *d, const straight_motion *m, cscd_free_step *out);
