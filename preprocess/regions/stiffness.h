/* How stiff the material is at triangles. */
#pragma once

#include "src/mesh/mesh.h"

/* Finds the stiffness of each triangle as a share of that of its component, in (0, 1]. A component is as stiff as the least stiff
 * half of its area at most is, so a small part that is stiffer than the rest makes nothing soft. given: of each triangle, positive
 * and finite. Shares are rounded to 24 bits, so that the unit does not matter, and are never less than 1e-6. */
cscd_status stiffness_shares(const cscd_mesh *mesh, const double *positions, const double *given,
                             double *shares);

/* The mean of the shares beside an edge; exactly 1 where all of them are. */
double stiffness_beside(const cscd_mesh *mesh, const double *shares, uint32_t edge);

/* The blindness for what lies far beyond soft material. More makes more regions than pay. */
#define BEYOND_BLINDNESS 0.3

/* What a step through material of these shares adds to the blindness: of one share s, 1 / s - 1 times its length, in roots of the
 * component's area. Two places are like two springs, one behind the other. */
static inline double soft_step(double share_a, double share_b, double length) {
    return (0.5 * (1.0 / share_a + 1.0 / share_b) - 1.0) * length;
}
