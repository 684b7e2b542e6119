/* Pairs of features that have no mesh: four points each, decided by the queue and the kernels of a step. */
#pragma once

#include "runtime/ccd/min_separation.h"
#include "src/core/context.h"

/* VF: a vertex and the three of a triangle. EE: the two ends of each edge. */
typedef struct point_pairs {
    cscd_contact_kind kind;
    size_t count;
    const double *x0, *x1; /* four points of three coordinates for each pair, one pair after the other */
} point_pairs;

/* A function that is told of each pair that comes into contact, by the pair's number and in no certain order. The
 * contact's own numbers mean nothing. */
typedef void point_pair_found(void *user, size_t pair, const cscd_contact *contact);

/* The pairs that one call of point_pairs_test takes at most. */
enum { POINT_PAIRS_MAX = 128 };

/* Tests up to POINT_PAIRS_MAX pairs on the calling thread, without an allocation: for contact or, with a distance above 0,
 * for coming within it. Every bit is that of a step over a mesh that holds these features. */
void point_pairs_test(cscd_context *context, const point_pairs *pairs, separation limit,
                      point_pair_found *found, void *user);

/* Returns the distance between the points that u and v name on the features of these four points. */
double point_pair_distance(cscd_contact_kind kind, const double (*x)[3], double u, double v);
