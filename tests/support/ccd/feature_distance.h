/* The distance of two moving features, in long double and by cases: nothing in common with the oracle. */
#pragma once

#include "tests/support/ccd/elementary_cases.h"

/* To a rounding of the largest coordinate, and better where coordinates are small integers. */
long double feature_distance(cscd_contact_kind kind, const elementary_query *query, long double t);

/* Of the points that u and v name. */
long double named_distance(cscd_contact_kind kind, const elementary_query *query, long double t,
                           long double u, long double v);

/* Proves, by intervals of time and the speed at which the features can close, that they stay farther apart
 * than distance from low to high. false: they do not, or that would take too many intervals. */
bool proved_apart(cscd_contact_kind kind, const elementary_query *query, long double low, long double high,
                  long double distance);

long double largest_coordinate(const elementary_query *query);

/* Of a point, from t = 0 to t = 1. */
long double largest_displacement(const elementary_query *query);
