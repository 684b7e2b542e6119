/* Two moving features in their own frame, and their nearest points at one moment. */
#pragma once

#include "runtime/ccd/elementary.h"
#include "runtime/ccd/separating_plane.h"

/* What the frame of a query is relative to: the first point at t = 0, or the first point at each time. In the moving
 * frame the offset between the nearest points is computed with twice the digits, for features that are much nearer to
 * each other than they are long. */
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

/* Scales the query so that no later product over- or underflows. The subtraction rounds, so coordinates are off by at
 * most 2^-53. Scaling is exact, also for distances: their exponent stays within 1000. In the moving frame points are
 * relative to the first one at either end, which changes no distance, and the extent does not grow with a motion that
 * they have in common. */
local_query local_query_of(const elementary_query *query, cscd_contact_kind kind, query_frame frame);

/* The largest coordinate of the local points at t = 0. */
double local_query_extent_at_start(const local_query *local);

/* The features at t = 0, with their velocities. */
feature_moment feature_moment_start(const local_query *local);

/* Moves the features to time t. Each coordinate is off by at most 3 * 2^-53: (1 - t) x0 rounds twice, t x1 once, and
 * their sum once. */
void feature_moment_move(const local_query *local, double t, feature_moment *m);
