/* A moving vertex and a half-space whose normal is fixed and whose plane moves with a point: exact at distance 0, and
 * with a distance by bounds, since the vertex's height above the plane is linear in time. */
#pragma once

#include "runtime/ccd/pair_plane.h"
#include "runtime/ccd/separation_floor.h"

/* x[0] is the vertex, x[1] the point of the plane; both move linearly from x0 (t = 0) to x1 (t = 1). */
typedef struct half_space_query {
    double x0[2][3], x1[2][3];
    double normal[3]; /* out of the half-space, of any length but 0 */
} half_space_query;

/* How far the vertex is above the plane in the positions x; below 0 inside. The height is off by at most `error`, and
 * `extent` is the largest difference of a coordinate of the two points. */
typedef struct plane_height {
    double value, error, extent;
} plane_height;

plane_height half_space_height(const double x[2][3], const double normal[3]);

/* Is the vertex ever on the plane or behind it? contact->toi is never after the first such moment, and less than 1e-9
 * before it. u and v are 0, and the normal is that of the half-space. *contact is written only with true. */
elementary_verdict half_space_touch(const half_space_query *query, elementary_contact *contact);

/* Does the vertex come within the distance of the plane? What separation_vf promises holds here; nothing is bounded. */
bool half_space_within(const half_space_query *query, double distance, elementary_contact *contact);

/* Does the vertex keep its floor above the plane? See separation_floor_test. */
floor_verdict half_space_floor_test(const half_space_query *query, const floor_ladder *ladder,
                                    elementary_contact *contact);

/* Returns a number that is at most the vertex's height less the length, and at least 0.985 times that; see pair_gap. */
double half_space_gap(const double x[2][3], const double normal[3], double length);

/* The plane of the half-space as one between a pair. Its normal is the half-space's times a power of two, without any
 * rounding, so that it is not of length 1: `gap` and heights are in units of it. Returns its length, or a little more. */
double half_space_plane(const double x[2][3], const double normal[3], pair_plane *out);
