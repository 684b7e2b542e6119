/* Winding numbers of a small scene by brute force: a ray along x, and the point off a corner written out in powers of
 * epsilon. */
#pragma once

#include "runtime/intersections/named_surface.h"
#include "tests/support/intersections/grid_scene.h"

/* So many vertices leave powers of epsilon for the point. */
enum { WINDING_NAMES = 14 };

/* The winding number of an object at the point, whose scene has no more vertices than that. */
int winding_oracle_number(const grid_scene *s, corner_side at, uint32_t object);
