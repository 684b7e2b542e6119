/* The springs of the IPC solver, and the linear system of a Newton step: springs, which are never assembled, and the matrix of
 * contacts that the library gives. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/body.h"

/* ---- elasticity of closed bodies ----------------------------------------------------------------------- */

/* Energy: stiffness / 2 * (length - rest)^2. */
typedef struct ipc_spring {
    uint32_t a, b; /* a < b */
    double rest, stiffness;
} ipc_spring;

/* Grows from {0}; sorted by (a, b), without repetitions. ipc_springs_free releases it. */
typedef struct ipc_springs {
    ipc_spring *items;
    uint32_t count, capacity;
} ipc_springs;

typedef struct ipc_stuff {
    double density;  /* mass per volume */
    double membrane; /* stiffness of the surface: force per length of every edge */
    double solid;    /* stiffness of the inside: force per area */
} ipc_stuff;

/* Adds a closed body whose first vertex has this number: a spring for each edge, and from each vertex five
 * struts that run inwards, straight and tilted, to the opposite surface. So the body keeps its shape,
 * about equally stiff for any size of triangles. */
void ipc_springs_add_body(ipc_springs *springs, const body *b, uint32_t first_vertex, const ipc_stuff *stuff);
void ipc_springs_free(ipc_springs *springs);

double ipc_springs_energy(const ipc_springs *springs, const double *positions);
void ipc_springs_add_gradient(const ipc_springs *springs, const double *positions, double *gradient);

/* The Hessian of a spring: the block B = along * n n^T + aside * I at (a, a) and (b, b), and -B at (a, b)
 * and (b, a). The part that would make it indefinite is left out: a compressed spring also pushes aside. */
typedef struct ipc_spring_hessian {
    double n[3], along, aside;
} ipc_spring_hessian;

/* Computes one Hessian for each spring. */
void ipc_springs_hessians(const ipc_springs *springs, const double *positions, ipc_spring_hessian *hessians);

/* Adds Hessian * x to out. */
void ipc_springs_add_product(const ipc_springs *springs, const ipc_spring_hessian *hessians, const double *x,
                             double *out);

/* Computes the area of each vertex: a third of that of its triangles. */
void ipc_vertex_areas(const body *b, double *areas);

/* ---- the linear system --------------------------------------------------------------------------------- */

/* A symmetric 3 x 3 matrix: xx, xy, xz, yy, yz, zz. */
typedef struct ipc_block {
    double m[6];
} ipc_block;

/* inertia + springs + contacts: a positive definite matrix on the vertices whose inertia is above 0. The
 * other vertices do not move. */
typedef struct ipc_system {
    uint32_t vertex_count;
    const double *inertia; /* per vertex: mass / (time step)^2 */
    ipc_springs springs;   /* not owned */
    cscd_energy_pattern pattern;
    const double *contacts;       /* in the places of the pattern, block by block */
    ipc_spring_hessian *hessians; /* per spring */
    ipc_block *inverses;          /* per vertex, of the matrix's diagonal */
    double *residual, *preconditioned, *search, *product;
} ipc_system;

/* inertia and the springs' items are not copied. ipc_system_free releases the rest. */
ipc_system ipc_system_make(uint32_t vertex_count, const double *inertia, const ipc_springs *springs);
void ipc_system_free(ipc_system *s);

/* Sets the matrix for these positions and these contacts, in blocks. The arrays are not copied. */
void ipc_system_set(ipc_system *s, const double *positions, const cscd_energy_pattern *pattern,
                    const double *contacts);

/* Computes out = matrix * x; out is 0 at vertices without inertia. */
void ipc_system_product(const ipc_system *s, const double *x, double *out);

/* Solves matrix * x = -gradient approximately, by conjugate gradients that are preconditioned by the
 * inverses of the 3 x 3 blocks on the diagonal. On entry, x says how far each vertex without inertia
 * moves; the others start from 0. Stops when the residual in the norm of the preconditioner has fallen to
 * `tolerance` of its first value, or after `most` iterations; when no vertex without inertia moves, x is a
 * descent direction wherever it stops. Returns the number of iterations. */
uint32_t ipc_system_solve(ipc_system *s, const double *gradient, double tolerance, uint32_t most, double *x);
