/* How much farther apart than a length two features at rest are, by integers. */
#pragma once

#include "runtime/ccd/elementary.h"

/* Returns a number that is at most the distance of the features less the length, and at least 1 - 2^-40 times that.
 * Returns 0 if they are no farther apart, or by less than 2^-352, which no two coordinates differ by. x: the points, as
 * in an elementary_query. */
double exact_gap(cscd_contact_kind kind, const double x[4][3], double length);
