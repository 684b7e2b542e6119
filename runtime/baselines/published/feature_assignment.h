/* From pairs of triangles to pairs of features, each of which is tested once (Yeh 2012, section 4.6; Tang et al. 2009). */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* Tests a pair of features of two triangles; a and b as in cscd_contact. */
typedef void feature_test(void *data, cscd_contact_kind kind, uint32_t a, uint32_t b);

/* Calls the test for the pairs of features that this pair of triangles is to test: those that share no vertex and are assigned to
 * it. A feature is assigned to the first triangle of its oneRingList, whichever pairs are looked at; or, with
 * CSCD_OURS_REPRESENTATIVES, a pair of features to the first pair of triangles that is. */
void feature_assignment_test(const own_interval *interval, uint32_t a, uint32_t b, feature_test *test,
                             void *data);
