/* Whether a point lies on the surface of a body, exactly. */
#pragma once

#include "runtime/bvh/bvh_query.h"
#include "runtime/intersections/intersections.h"

/* Does the point lie on a triangle of the body's closed components? The bounds of the trees are those of the surface's
 * positions. */
bool body_has_point(const named_surface *s, const bvh *f, uint32_t body, const double x[3]);
