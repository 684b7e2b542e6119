/* Equalizes charge densities: a value becomes the share of triangles that have no higher one. */
#pragma once

#include "src/mesh/mesh.h"

/* equalized[t], in (0, 1]: the triangle's rank in its component, from 1, divided by the component's triangle
 * count. Densities are first rounded to 24 bits; then ties are broken by index. Any finite densities.
 * INVALID_ARGUMENT names the triangle whose density is not finite. */
cscd_status equalize(const cscd_mesh *mesh, const double *density, double *equalized);
