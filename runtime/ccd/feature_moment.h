/* Two moving features in their own frame, their nearest points at one moment, and planes that keep them
 * apart from then on. */
#pragma once

#include "runtime/ccd/ccd.h"

/* ---- planes: how long one that turns with two moving features keeps them farther apart than a distance --- */

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

/* Returns the number of edges: 1-2, 1-3, 2-3 (vertex and face) or 0-1, 2-3. */
static inline int separating_plane_edges(cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_VF ? 3 : 2;
}

/* The plane that is parallel to the edges in a set, of which two count: in thin faces, and near edges that
 * are nearly parallel, rounding hides in which of them the connection ends. */
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

/* ---- moments ------------------------------------------------------------------------------------------- */

/* The origin of the frame of a query: the first point at t = 0, or the first point at each time. In the
 * moving frame the offset between the nearest points is computed with twice the digits, for features that
 * are much nearer to each other than they are long. */
typedef enum query_frame { FRAME_AT_REST, FRAME_MOVING } query_frame;

/* A query relative to its first point, scaled by a power of two to an extent in [1/2, 1). */
typedef struct local_query {
    elementary_query at;
    cscd_contact_kind kind;
    query_frame frame;
    double scale, distance; /* the limit's distance, which the caller scales, too */
    bool still;             /* nothing moves, in this frame */
} local_query;

/* The features at one moment. */
typedef struct feature_moment {
    double t, u, v, distance;
    moving_features features;
    shortest_connection shortest;
    double middle[3]; /* of the shortest connection */
} feature_moment;

/* Scales the query so that no later product over- or underflows. The subtraction rounds, so coordinates are
 * off by at most 2^-53. Scaling is exact, also for distances: their exponent stays within 1000. In the
 * moving frame points are relative to the first one at either end, which changes no distance, and the extent
 * does not grow with a motion that they have in common. */
local_query local_query_of(const elementary_query *query, cscd_contact_kind kind, query_frame frame);

/* The largest coordinate of the local points at t = 0. */
double local_query_extent_at_start(const local_query *local);

/* The features at t = 0, with their velocities. */
feature_moment feature_moment_start(const local_query *local);

/* Moves the features to time t. Each coordinate is off by at most 3 * 2^-53: (1 - t) x0 rounds twice, t x1
 * once, and their sum once. */
void feature_moment_move(const local_query *local, double t, feature_moment *m);

/* ---- steps from one moment to the next ----------------------------------------------------------------- */

/* The finest tolerance in the units of a local query. Its extent is at least 1/2, so this is no larger than
 * promised. It is 16 times the error of a distance and 8 times SEPARATING_PLANE_ERROR, so the steps get down
 * to distance and tolerance and do not end before them. */
#define SEPARATION_FINEST_LOCAL (0.5 * SEPARATION_FINEST)

/* The same for a query in its own frame, with its distance and the tolerance scaled. */
bool approach_within(const elementary_query *query, const local_query *local, double tolerance,
                     elementary_contact *contact, bool *bounded);
