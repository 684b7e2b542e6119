/* Continuous normal cones: a cone of directions that holds every normal of a set of triangles during a whole
 * interval (Provot 1997; Tang et al. 2009). Eight at a time. */
#pragma once

#include "src/core/kernels.h"
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

typedef struct normal_cone_kernels {
    /* The cones of eight triangles, whose corners move linearly. A normal, the cross product of two edges, is quadratic
     * in time: its cone holds all three Bernstein vectors and with them every normal between. published: it holds the
     * normals at the two ends only, so normals between may lie outside, and it may be wider than the limit. */
    void (*of_triangles)(const uint32_t (*triangles)[3], const uint32_t which[LANES], const double *x0,
                         const double *x1, bool published, normal_cone out[LANES]);

    /* A cone of all eight, as of_triangles with published = false. */
    void (*of_eight)(const uint32_t (*triangles)[3], const uint32_t which[LANES], const double *x0,
                     const double *x1, normal_cone *out);

    /* The cones that each hold two of those given (thesis, equations 5.1 and 5.2); there is none where it would be wider
     * than the limit. */
    void (*of_unions)(const normal_cone *cones, const uint32_t a[LANES], const uint32_t b[LANES], float limit,
                      normal_cone out[LANES]);
} normal_cone_kernels;

DECLARE_KERNELS(normal_cone_kernels);

static inline const normal_cone_kernels *normal_cone_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, normal_cone_kernels);
}
