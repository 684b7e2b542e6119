/* Where an edge passes through a triangle, in general position: without integers, where rounding is certain. */
#pragma once

#include "runtime/intersections/event_point.h"

/* p: the edge's points, then the triangle's, of an event that happens. False: a determinant may be 0, or a result lies too near to the middle between
 * two doubles; nothing is known then. */
bool rounded_point_find(const double *const p[5], event_point *out);
