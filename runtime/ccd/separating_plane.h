/* How long a plane that turns with two moving features keeps them farther apart than a distance. */
#pragma once

#include "runtime/ccd/elementary.h"

#include <stdbool.h>

/* Two features at one moment. Their coordinates are below 1 in magnitude during the whole interval. */
typedef struct moving_features {
    cscd_contact_kind kind;
    double x[4][3], velocity[4][3]; /* off by at most 3 * 2^-53 and 2 * 2^-53 each */
} moving_features;

/* The shortest connection of the features. */
typedef struct shortest_connection {
    double offset[3]; /* from b's nearest point to a's, not 0 */
    double change[3]; /* of offset, per time, while both points keep their parameters */
    bool inside[3];   /* of the edges 1-2, 1-3, 2-3 (vertex and face) or 0-1, 2-3: does it end between the
                       * ends? In a face: of the first two */
} shortest_connection;

/* Perpendicular to normal + s * turn at time s from now; normal is a unit vector up to rounding. */
typedef struct separating_plane {
    double normal[3], turn[3];
    int axis_count;
} separating_plane;

/* The plane that stays, to first order, across the shortest connection and along axes_max of the edges in
 * which that ends, or fewer: axis_count. Two edges that are nearly parallel tilt it by rounding; fewer do
 * not. */
separating_plane separating_plane_find(const moving_features *features, const shortest_connection *shortest,
                                       int axes_max);

/* What separating_plane_holds must allow for rounding: it proves nothing to features that are no more than
 * this beyond the distance. */
#define SEPARATING_PLANE_ERROR 0x1p-46

/* For how long from now does the plane keep each point of a more than distance beyond each point of b? Found
 * times of 1 or more, INFINITY among them, mean until the end of the interval; 0: not even now. Holds for any
 * plane: a bad one only gives a short time. */
double separating_plane_holds(const moving_features *features, const separating_plane *plane,
                              double distance);
