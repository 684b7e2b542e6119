/* Contact and friction: what cscd_detector_near finds, as constraints on positions. */
#pragma once

#include "cscd/cscd.h"

/* Two features to be kept apart along a normal, which like the weights stays as it was when they were found.
 */
typedef struct apart_pair {
    cscd_stencil stencil;
    double normal[3]; /* from the second to the first */
    double healing;   /* the share of what it lacks to the thickness that one small step gives it */
} apart_pair;

typedef struct apart {
    apart_pair *pairs; /* in the order of the detector, those with obstacles last */
    size_t count, capacity;
    double thickness;  /* the distance to be kept */
    double healing[2]; /* of pairs within cloth; of those with an obstacle */
    double friction;   /* Coulomb's coefficient */
} apart;

void apart_free(apart *a);

/* Forgets the pairs before. Two edges whose nearest points lie at an end of one are left to the vertex there.
 */
void apart_take(apart *a, const cscd_mesh *mesh, const cscd_proximities *near);

/* One pass in order. A pair on its way to come nearer than `thickness` is stopped, and slowed down along the
 * surface by friction. One that is nearer is moved apart, and `previous` with it, so that no speed comes of
 * it. Vertices with inverse mass 0 stay. */
void apart_solve(const apart *a, const double *inverse_masses, double *previous, double *positions);

/* The weighted sum of a stencil's vertices. */
void apart_sum(const cscd_stencil *s, const double *positions, double sum[3]);

/* Moves the vertices so that the sum changes by `change`: by weight and inverse mass, so that momentum is
 * kept. */
void apart_push(const cscd_stencil *s, const double *inverse_masses, const double change[3],
                double *positions);
