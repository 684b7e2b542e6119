/* Cloth as springs along its edges and stiff hinges across them: extended position-based dynamics (XPBD,
 * Macklin et al. 2016) with one iteration a small step (Macklin et al. 2019). */
#pragma once

#include "models/shapes/body.h"

typedef struct fabric_material {
    double density; /* mass per area */
    double stretch; /* force per length of a spring; springs across cells resist shear */
    double bending; /* force times length: resistance to curvature */
    double damping; /* seconds: stretching and bending motion dies away as with Rayleigh's coefficient */
    double drag;    /* share of the velocity that the air takes per second (1/s) */
} fabric_material;

typedef struct fabric_spring {
    uint32_t vertices[2];
    double rest, compliance;
} fabric_spring;

/* Two triangles at an edge. The weighted sum of the four vertices is 0 when they are flat and grows with
 * the angle (Bergou et al., "A quadratic bending model for inextensible surfaces", 2006). */
typedef struct fabric_hinge {
    uint32_t vertices[4]; /* the two of the edge, then the two opposite */
    double weights[4];
    double rest; /* length of that sum at rest */
    double compliance;
} fabric_hinge;

typedef struct fabric {
    uint32_t vertex_count, spring_count, hinge_count;
    fabric_spring *springs; /* one for each edge, by (smaller, larger vertex) */
    fabric_hinge *hinges;   /* one for each edge of two triangles, in the same order */
    double *inverse_masses; /* per vertex; 0 holds it in place */
    double damping, drag;
} fabric;

/* Makes a fabric whose rest shape is the body. Every vertex belongs to a triangle, and every edge to at
 * most two. */
fabric fabric_make(const body *rest, const fabric_material *m);
void fabric_free(fabric *f);

/* Solves all springs and hinges once, always in the same order: alternating the order would never come to
 * rest, since each order ends in a slightly different place. previous: positions at the start of the small
 * step; step: in seconds. */
void fabric_solve(const fabric *f, double step, const double *previous, double *positions);

/* Returns the kinetic energy plus the energy of springs and hinges. */
double fabric_energy(const fabric *f, const double *positions, const double *velocities);
