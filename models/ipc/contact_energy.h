/* The energy of the barrier over all pairs of features nearer than its reach, as a list of terms. */
#pragma once

#include "cscd/cscd.h"

/* One item of the list. Its Hessian is approximated by curvature * g g^T, where g, the gradient of the distance, is
 * weights[i] * normal at vertex i; see ipc_contacts_find. */
typedef struct ipc_contact {
    uint32_t vertices[4];
    double weights[4], normal[3];
    double gradient[4][3]; /* gradient of the energy */
    double energy, curvature;
} ipc_contact;

/* Grows from {0}; ipc_contacts_free releases it. */
typedef struct ipc_contacts {
    ipc_contact *items;
    size_t count, capacity;
    double energy, least_distance; /* the sum of energies; the least distance, INFINITY without pairs */
} ipc_contacts;

typedef struct ipc_barrier_options {
    double reach;     /* pairs nearer than this repel */
    double stiffness; /* kappa: the factor of the barrier */
} ipc_barrier_options;

/* The terms of `near`, found at `positions` in the form without repetitions: each counts as many times as the pairs
 * of features that it stands for. So the sum is that over all pairs, and continuous, for each distance is; a sum
 * without the counts would jump where a nearest point passes from a face to its edge.
 *
 * The gradient is exact: how the nearest points slide along the features does not change the distance to
 * first order. The Hessian leaves out that they slide and the normal turns, slope * (Hessian of the
 * distance), which only ever takes curvature away while the features are convex and the slope negative; so
 * what is left is positive semidefinite, and the directions that come of it lead down. Pairs of edges that
 * are nearly parallel, whose nearest points jump, fade out; pairs of vertices and faces take over there. */
void ipc_contacts_find(ipc_contacts *contacts, const double *positions, const cscd_proximities *near,
                       const ipc_barrier_options *options);
void ipc_contacts_free(ipc_contacts *contacts);

void ipc_contacts_add_gradient(const ipc_contacts *contacts, double *gradient);

/* Adds Hessian * x to out. */
void ipc_contacts_add_product(const ipc_contacts *contacts, const double *x, double *out);
