/* Elastic tetrahedra as constraints of XPBD: neo-Hookean, with separate constraints for volume and shape. */
#pragma once

#include "models/softbody/lattice.h"

typedef struct material {
    double density;        /* mass per volume */
    double young, poisson; /* stiffness (force per area); from above 0 to 0.49, how well volume is kept */
    double damping;        /* share of a cell's motion that is not rigid and is lost per second (1/s) */
} material;

typedef struct tetrahedron {
    uint32_t nodes[4];
    double to_rest[3][3]; /* inverse of the matrix whose columns are the rest edges from nodes[0] */
    double volume;
    double shear, bulk; /* Lame's mu and lambda */
} tetrahedron;

/* Makes five tetrahedra for each cell, 5 * cell_count, to be freed. The body has the mass of its cells,
 * which cover more than the inside of the surface. */
tetrahedron *tetrahedra_make(const lattice *l, const material *m);

/* Does one iteration of XPBD over all tetrahedra, in order (Macklin and Mueller, "A constraint-based
 * formulation of stable neo-Hookean materials", 2021, equations 9 and 10). inverse_masses: per node; step:
 * in seconds. */
void tetrahedra_solve(const tetrahedron *tetrahedra, uint32_t count, const double *inverse_masses,
                      double step, double *nodes);

/* Returns the energy above that of the rest shape. */
double tetrahedra_energy(const tetrahedron *tetrahedra, uint32_t count, const double *nodes);
