/* The barrier of incremental potential contact: an energy that rises without bound as a distance goes to 0.
 */
#pragma once

/* A function of one variable, with its derivatives. */
typedef struct ipc_curve {
    double value, slope, curvature;
} ipc_curve;

/* -(d - reach)^2 ln(d / reach) below the reach, 0 from there on (Li et al., "Incremental potential contact:
 * intersection- and inversion-free, large-deformation dynamics", 2020). Two derivatives are continuous at the
 * reach; infinite at 0 and below. */
ipc_curve ipc_barrier(double distance, double reach);

/* What the energy of two edges is multiplied by: 1 where they cross at an angle, 0 where they are parallel,
 * with one continuous derivative (as there). crossing: the squared length of the edges' cross product;
 * threshold: below this one. */
ipc_curve ipc_mollifier(double crossing, double threshold);
