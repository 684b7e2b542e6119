/* Which components are convex. */
#pragma once

#include "src/mesh/mesh.h"

/* Of each component: closed, manifold, consistently oriented, of Euler characteristic 2, and no edge concave
 * by more than 1e-6 of the component's size. A triangle without area makes no edge concave. */
cscd_status find_convex_components(const cscd_mesh *mesh, const double *positions, bool *convex);
