/* Minimum separation: do a moving vertex and face, or two moving edges, come within a distance, and when? */
#include "runtime/ccd/min_separation.h"

#include "runtime/ccd/closest.h"
#include "runtime/ccd/kdop_directions.h"
#include "runtime/ccd/separating_plane.h"
#include "src/core/vec3.h"

/* The features are farther apart than the computed distance by at most this. The computed distance is that of
 * two of their points. In units of 2^-53, each coordinate of the offset between these is off by at most
 *     8 for the two points: 3 each, and 1 each from the subtraction in localise_query,
 *     2 for the first difference, which is below 2,
 *     4 for the two differences that are weighed by u and v, which are at most 1,
 *     4 for these two products,
 *     4 for the two sums.
 * Together these are 22. A sum u + v above 1 by rounding adds at most 2. So the vector is off by 24 sqrt 3 <
 * 42, and its length rounds by less than 12. */
#define DISTANCE_ERROR 0x1p-47

/* At a distance below this, the direction from one point to the other is only rounding. */
static const double too_near = 0x1p-46;

/* A query relative to its first point, scaled by a power of two. */
typedef struct local_query {
    elementary_query at;
    cscd_contact_kind kind;
    double scale, distance; /* the limit's distance is scaled, too */
    bool still;             /* nothing moves */
} local_query;

/* The features at one moment. */
typedef struct feature_moment {
    double t, u, v, distance;
    moving_features features;
    shortest_connection shortest;
    double middle[3]; /* of the shortest connection */
} feature_moment;

/* ---- the query ------------------------------------------------------------------------------------- */

static double query_extent(const elementary_query *query) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            largest = max_of(largest, fabs(query->x0[i][k] - query->x0[0][k]));
            largest = max_of(largest, fabs(query->x1[i][k] - query->x0[0][k]));
        }
    }
    return largest;
}

/* Scales the query to an extent in [1/2, 1), so that no later product over- or underflows. The subtraction
 * rounds, so coordinates are off by at most 2^-53. Scaling is exact, also for the distance: its exponent
 * stays within 1000. */
static local_query localise_query(const elementary_query *query, cscd_contact_kind kind, double distance) {
    local_query local = {.kind = kind, .still = memcmp(query->x0, query->x1, sizeof query->x0) == 0};
    int exponent = 0;
    frexp(query_extent(query), &exponent);
    local.scale = ldexp(1.0, -exponent);
    local.distance = distance * local.scale;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            local.at.x0[i][k] = (query->x0[i][k] - query->x0[0][k]) * local.scale;
            local.at.x1[i][k] = (query->x1[i][k] - query->x0[0][k]) * local.scale;
        }
    }
    return local;
}

/* ---- the features at a moment ---------------------------------------------------------------------- */

static void connect_vf(feature_moment *m) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    const double(*velocity)[3] = (const double(*)[3])m->features.velocity;
    closest_point_triangle(x[0], x[1], x[2], x[3], &m->u, &m->v);
    double u = m->u, v = m->v;
    for (int k = 0; k < 3; k++) {
        m->shortest.offset[k] = (x[0][k] - x[1][k]) - u * (x[2][k] - x[1][k]) - v * (x[3][k] - x[1][k]);
        m->shortest.change[k] = (velocity[0][k] - velocity[1][k]) - u * (velocity[2][k] - velocity[1][k]) -
                                v * (velocity[3][k] - velocity[1][k]);
        m->middle[k] = x[0][k] - 0.5 * m->shortest.offset[k];
    }
    bool on_last = u + v >= 1.0;
    m->shortest.inside[0] = u > 0.0 && u < 1.0 && !(on_last && v > 0.0);
    m->shortest.inside[1] = v > 0.0 && v < 1.0 && !(on_last && u > 0.0);
    m->shortest.inside[2] = u > 0.0 && v > 0.0 && on_last;
}

static void connect_ee(feature_moment *m) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    const double(*velocity)[3] = (const double(*)[3])m->features.velocity;
    closest_segments(x[0], x[1], x[2], x[3], &m->u, &m->v);
    double u = m->u, v = m->v;
    for (int k = 0; k < 3; k++) {
        m->shortest.offset[k] = (x[0][k] - x[2][k]) + u * (x[1][k] - x[0][k]) - v * (x[3][k] - x[2][k]);
        m->shortest.change[k] = (velocity[0][k] - velocity[2][k]) + u * (velocity[1][k] - velocity[0][k]) -
                                v * (velocity[3][k] - velocity[2][k]);
        m->middle[k] = x[0][k] + u * (x[1][k] - x[0][k]) - 0.5 * m->shortest.offset[k];
    }
    m->shortest.inside[0] = u > 0.0 && u < 1.0;
    m->shortest.inside[1] = v > 0.0 && v < 1.0;
}

/* Moves the features to time t. Each coordinate is off by at most 3 * 2^-53: (1 - t) x0 rounds twice, t x1
 * once, and their sum once. */
static void move_to(const local_query *local, double t, feature_moment *m) {
    m->t = t;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++)
            m->features.x[i][k] = (1.0 - t) * local->at.x0[i][k] + t * local->at.x1[i][k];
    }
    if (local->kind == CSCD_CONTACT_VF)
        connect_vf(m);
    else
        connect_ee(m);
    m->distance = sqrt(vec3_dot(m->shortest.offset, m->shortest.offset));
}

static feature_moment start_moment(const local_query *local) {
    feature_moment m = {.features.kind = local->kind};
    for (int i = 0; i < 4; i++) vec3_subtract(local->at.x1[i], local->at.x0[i], m.features.velocity[i]);
    move_to(local, 0.0, &m);
    return m;
}

/* ---- conservative advancement ---------------------------------------------------------------------- */

/* Returns how long the features certainly stay apart from the moment on. Any plane is a proof, and a plane
 * along fewer axes may prove more. */
static double time_apart(const local_query *local, const feature_moment *m) {
    double longest = 0.0;
    for (int axes_max = 2; axes_max >= 0 && longest < 1.0 - m->t; axes_max--) {
        separating_plane plane = separating_plane_find(&m->features, &m->shortest, axes_max);
        longest = fmax(longest, separating_plane_holds(&m->features, &plane, local->distance));
        if (plane.axis_count < axes_max) axes_max = plane.axis_count;
        if (plane.axis_count < 2 && longest > 0.0) break;
    }
    return longest;
}

/* When nothing moves, the plane across the shortest connection usually proves that the features stay apart.
 */
static bool stays_apart(const local_query *local, const feature_moment *m) {
    separating_plane across = {.axis_count = 0};
    if (!local->still) return false;
    for (int k = 0; k < 3; k++) across.normal[k] = m->shortest.offset[k] / m->distance;
    return separating_plane_holds(&m->features, &across, local->distance) >= 1.0;
}

/* Steps from moment to moment, each as late as a plane keeps the features apart, until they are no farther
 * apart than reach. A time t + s is rounded down: multiplied by 1 - 2^-53 it becomes the next smaller double.
 */
static bool advance_moment(const local_query *local, double reach, feature_moment *m, bool *bounded) {
    *bounded = false;
    if (m->distance > reach && stays_apart(local, m)) return false;
    for (int step = 0; m->distance > reach; step++) {
        double time = time_apart(local, m);
        if (time >= 1.0 - m->t) return false;
        double later = (m->t + time) * (1.0 - 0x1p-53);
        if (step == SEPARATION_STEPS_MAX || !(later > m->t)) return *bounded = true;
        move_to(local, later, m);
    }
    return true;
}

/* Writes the features' own normal, turned against the motion of a relative to b. Features that touch have no
 * other, because their shortest connection has no direction. */
static void touching_normal(const feature_moment *m, double normal[3]) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    double a[3], b[3];
    bool vf = m->features.kind == CSCD_CONTACT_VF;
    vec3_subtract(x[vf ? 2 : 1], x[vf ? 1 : 0], a);
    vec3_subtract(x[3], x[vf ? 1 : 2], b);
    vec3_cross(a, b, normal);
    double length = sqrt(vec3_dot(normal, normal));
    double sign = vec3_dot(normal, m->shortest.change) > 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 3; k++) normal[k] = length > 0.0 ? sign * normal[k] / length : 0.0;
}

static void describe_contact(const elementary_query *query, const local_query *local, const feature_moment *m,
                             elementary_contact *contact) {
    *contact = (elementary_contact){.toi = m->t, .u = m->u, .v = m->v};
    for (int k = 0; k < 3; k++) {
        contact->point[k] = query->x0[0][k] + m->middle[k] / local->scale;
        contact->normal[k] = m->shortest.offset[k] / m->distance;
    }
    if (m->distance < too_near) touching_normal(m, contact->normal);
}

/* The extent is at least 1/2, so half of SEPARATION_FINEST is no larger a tolerance than promised. It is 16
 * times DISTANCE_ERROR and 8 times SEPARATING_PLANE_ERROR, so the steps get down to `reach` and do not
 * end before it. */
static bool comes_within(const elementary_query *query, cscd_contact_kind kind, const separation *limit,
                         elementary_contact *contact, bool *bounded) {
    local_query local = localise_query(query, kind, limit->distance);
    double tolerance = fmax(limit->tolerance * local.scale, 0.5 * SEPARATION_FINEST);
    double reach = local.distance + (tolerance - DISTANCE_ERROR);
    feature_moment m = start_moment(&local);
    bool ran_out;
    if (!advance_moment(&local, reach, &m, &ran_out)) return false;
    if (directions_part(query, kind, limit->distance)) return false;
    describe_contact(query, &local, &m, contact);
    *bounded = ran_out;
    return true;
}

bool separation_vf(const elementary_query *query, const separation *limit, elementary_contact *contact,
                   bool *bounded) {
    return comes_within(query, CSCD_CONTACT_VF, limit, contact, bounded);
}

bool separation_ee(const elementary_query *query, const separation *limit, elementary_contact *contact,
                   bool *bounded) {
    return comes_within(query, CSCD_CONTACT_EE, limit, contact, bounded);
}
