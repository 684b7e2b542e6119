/* Computes how long a plane that turns with two moving features keeps them farther apart than a distance. */
#pragma once

#include "runtime/ccd/elementary.h"

#include <stdbool.h>

/* Two features at one moment. Their coordinates stay below 1 in magnitude during the whole interval. */
typedef struct moving_features {
    cscd_contact_kind kind;
    double x[4][3], velocity[4][3]; /* off by at most 3 * 2^-53 and 2 * 2^-53 */
} moving_features;

/* The shortest connection of the features. */
typedef struct shortest_connection {
    double offset[3]; /* from b's nearest point to a's, not 0 */
    double change[3]; /* of offset, per time, while both points keep their parameters */
    bool inside[3];   /* of the edges 1-2, 1-3, 2-3 (vertex and face) or 0-1, 2-3: does it end between the
                       * ends? In a face: of the first two */
} shortest_connection;

/* The plane is perpendicular to normal + s * turn at time s from now. The normal is a unit vector up to
 * rounding. */
typedef struct separating_plane {
    double normal[3], turn[3];
    int axis_count;
} separating_plane;

/* Finds the plane that stays, to first order, perpendicular to the shortest connection and parallel to at
 * most axes_max of the edges in which the connection ends; axis_count says to how many. Rounding tilts a
 * plane along two edges that are nearly parallel. It does not tilt a plane along fewer edges. */
separating_plane separating_plane_find(const moving_features *features, const shortest_connection *shortest,
                                       int axes_max);

/* So many edges are counted: 1-2, 1-3, 2-3 (vertex and face) or 0-1, 2-3. */
static inline int separating_plane_edges(cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_VF ? 3 : 2;
}

/* The plane that is parallel to the edges in a set, of which two count: in thin faces, and beside edges that are nearly
 * parallel, rounding hides in which of them the connection ends. */
separating_plane separating_plane_along(const moving_features *features, const shortest_connection *shortest,
                                        unsigned edges);

/* The allowance of separating_plane_holds for rounding. It proves nothing about features that are no more
 * than this beyond the distance. */
#define SEPARATING_PLANE_ERROR 0x1p-46

/* Returns for how long from now the plane keeps each point of a more than distance beyond each point of b. A
 * time of 1 or more, which may be INFINITY, means until the end of the interval; 0 means not even now. The
 * time holds for any plane: a bad plane only gives a short time. */
double separating_plane_holds(const moving_features *features, const separating_plane *plane,
                              double distance);

/* Returns a distance that the features certainly have now. */
double separating_plane_gap(const moving_features *features, const separating_plane *plane);
