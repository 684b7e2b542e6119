/* Pairs of features that may come near each other on a motion, kept for every shorter motion. */
#pragma once

#include "runtime/detector/interval_search.h"

typedef struct candidates {
    candidate_list lists[2]; /* by cscd_contact_kind */
} candidates;

/* Collects every pair that, by its bounding volumes, comes within reach, or within its own distance if this is more,
 * between x0 and x1; the margin is added to both. Nothing is culled. The candidates of before are replaced; their memory is used again. */
cscd_status candidates_collect(cscd_detector *d, const double *x0, const double *x1, double reach,
                               double margin, candidates *out);

/* Takes over what the lanes have collected, in place of what there was. OUT_OF_MEMORY: what there is now is not all. */
cscd_status candidates_take(const search_space *s, candidates *out);
void candidates_free(cscd_context *context, candidates *c);

/* Tests all candidates in the interval that the search has begun with, and all vertices against half-spaces. */
cscd_status candidates_test(const candidates *c, interval_search *search);
