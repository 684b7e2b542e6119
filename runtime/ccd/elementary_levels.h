/* The levels of an elementary test, for those who go through them: signs, certified intervals about roots,
 * the inside test. */
#pragma once

#include "runtime/ccd/ccd.h"

/* ---- level one: signs ---------------------------------------------------------------------------------- */

/* Separating directions: planes that keep two moving features apart during the whole interval. */

/* These return true only for features that are certainly apart. They compare the points at one time, so the
 * axes and the diagonals together reject whatever swept 14-DOPs of the features would reject, and more. */
bool separated_by_axes(const elementary_query *query, cscd_contact_kind kind);
bool separated_by_diagonals(const elementary_query *query, cscd_contact_kind kind);

/* Tries directions in the features' common plane at mid-interval, for points that are nearly coplanar. */
bool separated_in_plane(const elementary_query *query, cscd_contact_kind kind);

/* The same from one time to another, both in [0, 1], also for features that have no common normal: parallel
 * edges, and a face that is a segment. The shorter the part, the fewer pairs that stay apart are left. */
bool separated_in_part(const elementary_query *query, cscd_contact_kind kind, double begin, double end);

/* Are all coefficients beyond the error on one side of zero? Then the points are never coplanar in [0,1]. */
bool coplanarity_excluded(const coplanarity *f);

/* ---- level two: certified intervals of time that hold the roots of the coplanarity cubic --------------- */

typedef struct root_interval {
    double begin, end;
    bool certain; /* the exact cubic has a root in it */
    /* A time that is not above the roots in it, at most 2^-34 below the begin, and the same for every guess; -1 where
     * the interval leaves that open. */
    double toi;
} root_interval;

enum { ROOTS_MAX = 3, ROOTS_UNCERTAIN = -1 };

/* Writes ascending disjoint intervals outside of which the exact cubic has no root in [0,1]. They are as
 * narrow as the cubic's error allows, and below 1/64. Returns how many there are, or ROOTS_UNCERTAIN when
 * that cannot be certified. */
int cubic_isolate(const coplanarity *f, root_interval out[ROOTS_MAX]);

/* Returns the slope of the computed cubic at t in [0,1]. */
double cubic_slope(const coplanarity *f, double t);

/* Guesses where a cubic's roots are; callers prove them. */

/* The time that callers report must not depend on how a root was guessed. So a time that follows from a
 * guess is rounded down to a multiple of this: the cell that the root is proven to be in names it, and every
 * right guess has the same cell. */
#define ROOT_CELL 0x1p-34

/* Writes approximate real roots of c[0] + c[1] t + c[2] t^2 + c[3] t^3 in ascending order, and returns how
 * many. Leading coefficients may be 0 or tiny. Roots outside of [0, 1] are only known to be outside, others
 * may be wrong, and some may be missing. */
int cubic_guess_roots(const double c[4], double roots[3]);

/* ---- level two: are features whose points are coplanar in an interval in touch? ------------------------ */

typedef enum inside_verdict { INSIDE_NO, INSIDE_YES, INSIDE_UNSURE } inside_verdict;

/* Says whether the features touch at none (NO) or at every one (YES) of the times in the interval at which
 * the four points are coplanar. The answer is certified. */
inside_verdict inside_test(const point_vectors *vectors, cscd_contact_kind kind,
                           const root_interval *interval);
