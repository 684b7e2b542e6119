/* Piercings and winding numbers of a small scene by brute force, in polynomials in epsilon. */
#pragma once

#include "runtime/intersections/named_surface.h"
#include "tests/support/intersections/grid_scene.h"

/* Does the edge pass through the triangle, without a common vertex? */
bool piercing_oracle_happens(const grid_scene *s, surface_piercing piercing);

/* The limits of s, u, v and of the point: numerators and one denominator of each kind. */
typedef struct exact_piercing_point {
    int64_t s, s_sum;     /* s / s_sum */
    int64_t u, v, uv_sum; /* u / uv_sum, v / uv_sum */
    int64_t x[3];         /* x[k] / s_sum */
} exact_piercing_point;

exact_piercing_point piercing_oracle_point(const grid_scene *s, surface_piercing piercing);

/* ---- winding numbers ----------------------------------------------------------------------------------- */

/* So many vertices leave powers of epsilon for the point. */
enum { WINDING_NAMES = 14 };

/* The winding number of an object at the point, whose scene has no more vertices than that. */
int winding_oracle_number(const grid_scene *s, corner_side at, uint32_t object);
