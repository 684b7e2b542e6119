/* How stiff the material is at triangles. */
#pragma once

#include "src/mesh/mesh.h"

/* Finds the stiffness of each triangle as a share of the greatest of its component, in (0, 1]. given: of each triangle, positive
 * and finite. Shares are rounded to 24 bits, so that the unit does not matter, and are never less than 1e-6. */
cscd_status stiffness_shares(const cscd_mesh *mesh, const double *given, double *shares);

/* The mean of the shares beside an edge; exactly 1 where all of them are. */
double stiffness_beside(const cscd_mesh *mesh, const double *shares, uint32_t edge);
