/* Contact and friction: turns the pairs of cscd_detector_find_near into constraints on positions. */
#pragma once

#include "cscd/cscd.h"

/* Two features that are kept apart along a normal. Normal and weights stay as they were when the pair was
 * found. */
typedef struct apart_pair {
    cscd_stencil stencil;
    double normal[3]; /* from the second to the first */
    double healing;   /* share of the missing distance that one small step adds */
} apart_pair;

typedef struct apart {
    apart_pair *pairs; /* in the order of the detector, those with obstacles last */
    size_t count, capacity;
    double thickness;  /* the distance to be kept */
    double healing[2]; /* of pairs within cloth, and of pairs with an obstacle */
    double friction;   /* Coulomb's coefficient */
} apart;

void apart_free(apart *a);

/* Replaces the pairs by new ones. When the nearest point lies at an end of an edge, the pair of that
 * vertex is kept and the pair of the edges is dropped. */
void apart_take(apart *a, const cscd_mesh *mesh, const cscd_proximities *near);

/* Solves all pairs once, in order. A pair that would come nearer than `thickness` is stopped, and friction
 * slows it down along the surface. A pair that is nearer already is moved apart, and `previous` with it,
 * so that it gains no speed. Vertices with inverse mass 0 stay. */
void apart_solve(const apart *a, const double *inverse_masses, double *previous, double *positions);

/* Sums the vertices of a stencil by their weights. */
void apart_sum(const cscd_stencil *s, const double *positions, double sum[3]);

/* Moves the vertices so that the sum changes by `change`: by weight and inverse mass, so that momentum is
 * kept. */
void apart_push(const cscd_stencil *s, const double *inverse_masses, const double change[3],
                double *positions);
