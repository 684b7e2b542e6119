/* Pairs of features that may come near each other on a motion, kept for every shorter one. */
#pragma once

#include "runtime/detector/interval_search.h"

typedef struct candidates {
    candidate_list lists[2]; /* by cscd_contact_kind */
} candidates;

/* Every pair that comes within a distance above 0 between x0 and x1, by its volumes; what was there before is
 * dropped, but its room. Nothing is culled. */
cscd_status candidates_collect(cscd_detector *d, const double *x0, const double *x1, double distance,
                               candidates *out);
void candidates_free(cscd_context *context, candidates *c);

/* Tests all of them in the interval that the search has begun with. */
cscd_status candidates_test(const candidates *c, interval_search *search);
