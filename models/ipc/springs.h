/* Elasticity of closed bodies by springs: along the edges of the surface, and as struts across the inside. */
#pragma once

#include "models/shapes/body.h"

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
