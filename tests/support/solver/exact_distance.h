/* Distances of features at rest, compared with lengths by rational numbers: no rounding anywhere. */
#pragma once

#include "cscd/cscd.h"

#include <gmp.h>
#include <stdbool.h>

/* Returns the sign of the features' distance less a length that is not negative. x: the points, as in an
 * elementary_query. Features may have no area and no length. */
int distance_sign(cscd_contact_kind kind, const double x[4][3], const mpq_t length);

/* The same for the length a + b / c, where the sum is exact and c is not 0. */
int distance_sign_of_sum(cscd_contact_kind kind, const double x[4][3], double a, double b, double c);

/* Are two points no farther apart than the length? */
bool points_within(const double a[3], const double b[3], double length);
