/* The linear system of a Newton step, never assembled, and its solution by conjugate gradients. */
#pragma once

#include "models/ipc/contact_energy.h"
#include "models/ipc/springs.h"

/* A symmetric 3 x 3 matrix: xx, xy, xz, yy, yz, zz. */
typedef struct ipc_block {
    double m[6];
} ipc_block;

/* inertia + springs + contacts, a positive definite matrix on the vertices whose inertia is above 0; the
 * others do not move. */
typedef struct ipc_system {
    uint32_t vertex_count;
    const double *inertia; /* per vertex: mass / (time step)^2 */
    ipc_springs springs;   /* shared */
    const ipc_contacts *contacts;
    ipc_spring_hessian *hessians; /* per spring */
    ipc_block *inverses;          /* per vertex, of the matrix's diagonal */
    double *residual, *preconditioned, *search, *product;
} ipc_system;

/* inertia and the springs' items are referred to. ipc_system_free takes it back. */
ipc_system ipc_system_make(uint32_t vertex_count, const double *inertia, const ipc_springs *springs);
void ipc_system_free(ipc_system *s);

/* The matrix at these positions, with these contacts, which are referred to. */
void ipc_system_set(ipc_system *s, const double *positions, const ipc_contacts *contacts);

/* out = matrix * x, 0 at vertices without inertia. */
void ipc_system_product(const ipc_system *s, const double *x, double *out);

/* x: on entry, how far each vertex without inertia goes; on return, besides, approximately the solution of
 * matrix * x = -gradient at the others, from 0 on, until the residual in the preconditioner's norm has fallen
 * to `tolerance` of what it was, or `most` iterations: where no vertex without inertia moves, x leads down
 * wherever that stops. Preconditioned by the inverses of the 3 x 3 blocks on the diagonal. Returns the
 * iterations. */
uint32_t ipc_system_solve(ipc_system *s, const double *gradient, double tolerance, uint32_t most, double *x);
