/* The barrier of incremental potential contact: an energy that rises without bound as a distance goes to
 * 0. */
#pragma once

/* A function of one variable, with its derivatives. */
typedef struct ipc_curve {
    double value, slope, curvature;
} ipc_curve;

/* Returns -(d - reach)^2 ln(d / reach) below the reach, 0 from there on, and infinity at 0 and below (Li
 * et al., "Incremental potential contact: intersection- and inversion-free, large-deformation dynamics",
 * 2020). Two derivatives are continuous at the reach. */
ipc_curve ipc_barrier(double distance, double reach);

/* Returns the factor of the energy of two edges: 1 where they cross at an angle, falling to 0 where they
 * are parallel, with one continuous derivative (same paper). crossing: the squared length of the edges'
 * cross product; threshold: the factor is 1 above it. */
ipc_curve ipc_mollifier(double crossing, double threshold);
