/* The energy of one pair by the formulas of Li et al. 2020, in long doubles, and its derivatives by differences. */
#pragma once

#include "cscd/energy.h"
#include "tests/support/random.h"

#include <stdbool.h>

/* The kinds of nearest features, in every form of an item that has them. */
typedef enum pair_shape {
    SHAPE_VF,        /* inside a face */
    SHAPE_VF_EDGE,   /* on an edge of the face; three of them */
    SHAPE_VF_CORNER, /* at a corner; three of them */
    SHAPE_EE,        /* inside both edges */
    SHAPE_EE_END,    /* an end of one of them; four */
    SHAPE_EE_ENDS,   /* ends of both; four */
    SHAPE_EV,
    SHAPE_EV_END,
    SHAPE_VV,
    SHAPE_VH,
    SHAPE_COUNT
} pair_shape;

/* One item, and the positions of its vertices. */
typedef struct energy_case {
    cscd_proximity item;
    double u, v; /* of its nearest points, as in cscd_contact */
    double x[12];
    cscd_energy_options options;
} energy_case;

/* The numbers by which an item counts. */
#define CASE_WEIGHT(c)     ((c)->options.by_count ? (c)->item.count : (c)->item.weight)
#define CASE_SEPARATION(c) ((c)->options.beyond ? (c)->item.separation : 0.0)

/* Makes a random pair of the shape, about `distance` apart, with edges about as long as 1. */
energy_case energy_case_make(random_stream *random, pair_shape shape, double distance);

/* The energy of a case at any positions, by the formula of its nearest features. */
long double energy_truth(const energy_case *c, const long double x[12]);

/* The gradient and the Hessian by extrapolated differences, with steps of this length at first. */
void energy_truth_derivatives(const energy_case *c, long double step, long double gradient[12],
                              long double hessian[12][12]);

/* The nearest positive semidefinite matrix, by an eigenvalue solver that knows nothing of pairs. */
void project_plainly(const double hessian[12][12], long double out[12][12]);
