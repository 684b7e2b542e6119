/* The linear system of a Newton step, never assembled, and its solution by conjugate gradients. */
#pragma once

#include "models/ipc/contact_energy.h"
#include "models/ipc/springs.h"

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
    const ipc_contacts *contacts;
    ipc_spring_hessian *hessians; /* per spring */
    ipc_block *inverses;          /* per vertex, of the matrix's diagonal */
    double *residual, *preconditioned, *search, *product;
} ipc_system;

/* inertia and the springs' items are not copied. ipc_system_free releases the rest. */
ipc_system ipc_system_make(uint32_t vertex_count, const double *inertia, const ipc_springs *springs);
void ipc_system_free(ipc_system *s);

/* Sets the matrix for these positions and contacts, which are not copied. */
void ipc_system_set(ipc_system *s, const double *positions, const ipc_contacts *contacts);

/* Computes out = matrix * x; out is 0 at vertices without inertia. */
void ipc_system_product(const ipc_system *s, const double *x, double *out);

/* Solves matrix * x = -gradient approximately, by conjugate gradients that are preconditioned by the
 * inverses of the 3 x 3 blocks on the diagonal. On entry, x says how far each vertex without inertia
 * moves; the others start from 0. Stops when the residual in the norm of the preconditioner has fallen to
 * `tolerance` of its first value, or after `most` iterations; when no vertex without inertia moves, x is a
 * descent direction wherever it stops. Returns the number of iterations. */
uint32_t ipc_system_solve(ipc_system *s, const double *gradient, double tolerance, uint32_t most, double *x);
