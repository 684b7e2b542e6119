/* The sign of the volume that a closed component encloses, exactly: is it right side out? */
#pragma once

#include "src/mesh/mesh.h"

#include <math.h>

/* Six times the volume of a closed component, and how far rounding may have moved it. */
typedef struct volume_estimate {
    double volume, rounding;
    const double *origin; /* volumes are measured from here; NULL: the component is open, and the rest 0 */
} volume_estimate;

/* Of each component. Positions are packed, and as src/mesh/predicates.h allows them. */
void volume_estimates_find(const cscd_mesh *mesh, const double *positions, volume_estimate *estimates);

/* Does the estimate tell the sign? */
static inline bool volume_estimate_decides(const volume_estimate *e) {
    return fabs(e->volume) > e->rounding;
}

/* The sign (-1, 0, 1) of the volume that these triangles enclose, all those of a closed component: 1 where normals are
 * outwards. Of a component that passes through itself, each place counts as often as the surface winds around it. */
int volume_sign_exact(const cscd_mesh *mesh, const double *positions, const uint32_t *triangles,
                      uint32_t count);
