/* The cubic whose roots are the times at which four moving points are coplanar. */
#pragma once

#include "runtime/ccd/elementary.h"

/* Three vectors between the points, at t = 0 ([0]) and t = 1 ([1]), rounded differences. VF: a, b the sides
 * of the face at its first corner, c from there to the vertex. EE: a, b the edges, c from the start of a to
 * that of b. */
typedef struct point_vectors {
    double a[2][3], b[2][3], c[2][3];
    double size_a[3], size_b[3], size_c[3]; /* largest magnitude of each component over both ends */
} point_vectors;

void point_vectors_from(const elementary_query *query, cscd_contact_kind kind, point_vectors *out);

typedef struct coplanarity {
    double b[4];  /* Bernstein coefficients of (A x B) . C */
    double error; /* no computed coefficient, nor a value between them, is farther from the exact one */
} coplanarity;

coplanarity coplanarity_cubic(const point_vectors *vectors);

/* Are all coefficients beyond the error on one side of zero? Then the points are never coplanar in [0,1]. */
bool coplanarity_excluded(const coplanarity *f);
