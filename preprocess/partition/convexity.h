/* Finds the convex components. */
#pragma once

#include "src/mesh/mesh.h"

/* A component is convex when it is closed, manifold, consistently oriented, of Euler characteristic 2, and no
 * edge is concave by more than 1e-6 of the component's size. A triangle without area makes no edge
 * concave. */
cscd_status find_convex_components(const cscd_mesh *mesh, const double *positions, bool *convex);
