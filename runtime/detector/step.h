/* One interval through the stages of the pipeline. */
#pragma once

#include "runtime/detector/detector.h"

/* check_ms and total_ms are left at 0. */
typedef struct step_outcome {
    cscd_contacts contacts;
    cscd_timings timings;
    cscd_counters counters;
} step_outcome;

/* Checks both arrays, and forgets what is known of triangles at other positions than x0. */
cscd_status step_check_positions(cscd_detector *d, const double *x0, const double *x1);

/* Finds the contacts between x0 and x1, both checked, that the mode promises, and fills in the guarantees. Then the
 * caller either takes the step or, only after a rehearsal, withdraws it. */
cscd_status step_find(cscd_detector *d, const double *x0, const double *x1, cscd_mode mode, bool rehearsal,
                      step_outcome *out);

/* The vertices have gone to the end of the interval found last: carries the states of its triangles over to there,
 * except in components whose contacts may be incomplete. */
void step_take(cscd_detector *d, const double *end);

/* The vertices have not gone there: the states are those at the interval's start again. */
void step_withdraw(cscd_detector *d);
