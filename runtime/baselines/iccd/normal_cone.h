/* Continuous normal cones: a cone of directions that holds every normal of a set of triangles during a whole
 * interval (Provot 1997; Tang et al. 2009). */
#pragma once

#include "src/mesh/mesh.h"

/* An angle of INFINITY says that there is no cone. Axes have length 1 up to rounding, for which angles allow. */
typedef struct normal_cone {
    float axis[3], angle; /* half the opening, in radians */
} normal_cone;

/* Cones of less than this have all their normals on one side of the plane across the axis, also when the axis
 * is off by 1e-4. */
static const float normal_cone_limit = 1.5706f;

static inline bool normal_cone_exists(const normal_cone *cone) {
    return cone->angle < normal_cone_limit;
}

/* The cone of one triangle, whose corners move linearly. Its normal, the cross product of two edges, is quadratic in
 * time: the cone holds all three Bernstein vectors and with them every normal between. */
normal_cone normal_cone_of(const uint32_t corners[3], const double *x0, const double *x1);

/* As published: the cone holds the normals at the two ends only, so normals between may lie outside. */
normal_cone normal_cone_of_ends(const uint32_t corners[3], const double *x0, const double *x1);

/* The cone that holds both (thesis, equations 5.1 and 5.2); there is none where it would be wider than the limit. */
normal_cone normal_cone_union(const normal_cone *a, const normal_cone *b, float limit);
