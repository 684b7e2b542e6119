/* A soft body: masses at the nodes of a lattice around a closed surface, elastic tetrahedra between them, and the
 * vertices of the surface, which the lattice carries along. */
#pragma once

#include "models/softbody/elastic.h"

typedef struct soft_body {
    lattice frame;
    tetrahedron *tetrahedra;
    double *masses, *inverse_masses; /* per node */
    double *nodes, *previous, *velocities;
    double *vertices;          /* of the surface, vertex_count * 3 */
    double *vertex_mobilities; /* inverse masses of the surface's vertices, as points of the lattice */
    double damping;
} soft_body;

/* Makes a body at rest as given; spacing is the width of the lattice's cells. */
soft_body soft_body_make(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                         uint32_t triangle_count, double spacing, const material *m);
void soft_body_free(soft_body *b);

/* Turns the body and then moves it, before the first step. */
void soft_body_place(soft_body *b, double turn[3][3], const double offset[3]);
void soft_body_throw(soft_body *b, const double velocity[3], const double spin[3]);

/* Moves a vertex of the surface together with the lattice around it. nodes: those of the body, or the
 * previous ones; moving both leaves the velocity unchanged. */
void soft_body_push(const soft_body *b, double *nodes, uint32_t vertex, const double change[3]);

/* Returns the kinetic, potential (of height z) and elastic energy. */
double soft_body_energy(const soft_body *b, double gravity);
