/* One interval through the stages of the pipeline. */
#pragma once

#include "runtime/detector/detector.h"

/* check_ms and total_ms are left at 0. */
typedef struct step_outcome {
    cscd_contacts contacts;
    cscd_timings timings;
    cscd_counters counters;
} step_outcome;

/* May positions hold this, and is what is known of triangles known of the start? Names are the arguments'. */
cscd_status step_check_positions(cscd_detector *d, const double *start, const double *end,
                                 const char *start_name, const char *end_name);

/* Finds the contacts between x0 and x1, both checked, that the mode promises, and what it could promise of
 * each component. Then either the vertices go to x1, or, after a rehearsal, they do not. */
cscd_status step_find(cscd_detector *d, const double *x0, const double *x1, cscd_mode mode, bool rehearsal,
                      step_outcome *out);

/* They have: the states of the triangles are those at the end of the interval found last. */
void step_take(cscd_detector *d, const double *end);

/* They have not: the states are those at its start. */
void step_withdraw(cscd_detector *d);
