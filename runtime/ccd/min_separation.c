/* Minimum separation: do a moving vertex and face, or two moving edges, come within a distance, and when? */

#include "runtime/ccd/feature_moment.h"

#include "src/core/context.h"
#include "src/core/floating.h"
#include "src/core/vec3.h"

/* ---- limits ------------------------------------------------------------------------------------------- */

cscd_status separation_check(cscd_context *context, double min_separation, double tolerance) {
    if (!is_length(min_separation))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "min_separation is %g, expected 0 or a length from 2^-300 to 2^300",
                            min_separation);
    if (!(tolerance >= 0.0 && tolerance <= 1.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "tolerance is %g, expected a share in (0,1] of min_separation, or 0 for 1e-6",
                            tolerance);
    return CSCD_OK;
}

separation separation_limit(double distance, double tolerance) {
    return (separation){distance, (tolerance > 0.0 ? tolerance : 1e-6) * distance};
}

separation proximity_limit(double distance) {
    const double relative_tolerance = 0x1p-21; /* half of what is promised: the distance is rounded, too */
    return (separation){distance, relative_tolerance * distance};
}

/* ---- conservative advancement ---------------------------------------------------------------------- */

/* The features are farther apart than the computed distance by at most this. The computed distance is that of
 * two of their points. In units of 2^-53, each coordinate of the offset between these is off by at most
 *     8 for the two points: 3 each, and 1 each from the subtraction in local_query_of,
 *     2 for the first difference, which is below 2,
 *     4 for the two differences that are weighed by u and v, which are at most 1,
 *     4 for these two products,
 *     4 for the two sums.
 * Together these are 22. A sum u + v above 1 by rounding adds at most 2. So the vector is off by 24 sqrt 3 <
 * 42, and its length rounds by less than 12. */
#define DISTANCE_ERROR 0x1p-47

/* At a distance below this, the direction from one point to the other is only rounding. */
static const double too_near = 0x1p-46;

/* If the planes that rounding suggests prove no more than this share of what is left, all planes are tried. */
static const double too_short = 0x1p-6;

static double time_along_edges(const local_query *local, const feature_moment *m) {
    double longest = 0.0;
    for (unsigned edges = 0; edges < 1u << separating_plane_edges(local->kind); edges++) {
        separating_plane plane = separating_plane_along(&m->features, &m->shortest, edges);
        longest = fmax(longest, separating_plane_holds(&m->features, &plane, local->distance));
    }
    return longest;
}

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
    if (local->frame == FRAME_MOVING && longest < too_short * (1.0 - m->t))
        longest = fmax(longest, time_along_edges(local, m));
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
        feature_moment_move(local, later, m);
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
        double origin = query->x0[0][k];
        if (local->frame == FRAME_MOVING) origin = (1.0 - m->t) * origin + m->t * query->x1[0][k];
        contact->point[k] = origin + m->middle[k] / local->scale;
        contact->normal[k] = m->shortest.offset[k] / m->distance;
    }
    if (m->distance < too_near) touching_normal(m, contact->normal);
}

void separation_describe(const elementary_query *query, cscd_contact_kind kind, elementary_contact *contact) {
    local_query local = local_query_of(query, kind, FRAME_AT_REST);
    feature_moment m = feature_moment_start(&local);
    describe_contact(query, &local, &m, contact);
}

bool approach_within(const elementary_query *query, const local_query *local, double tolerance,
                     elementary_contact *contact, bool *bounded) {
    double reach = local->distance + (fmax(tolerance, SEPARATION_FINEST_LOCAL) - DISTANCE_ERROR);
    feature_moment m = feature_moment_start(local);
    bool ran_out;
    if (!advance_moment(local, reach, &m, &ran_out)) return false;
    if (directions_part(query, local->kind, local->distance / local->scale)) return false;
    describe_contact(query, local, &m, contact);
    *bounded = ran_out;
    return true;
}

static bool comes_within(const elementary_query *query, cscd_contact_kind kind, const separation *limit,
                         elementary_contact *contact, bool *bounded) {
    local_query local = local_query_of(query, kind, FRAME_AT_REST);
    local.distance = limit->distance * local.scale;
    return approach_within(query, &local, limit->tolerance * local.scale, contact, bounded);
}

bool separation_vf(const elementary_query *query, const separation *limit, elementary_contact *contact,
                   bool *bounded) {
    return comes_within(query, CSCD_CONTACT_VF, limit, contact, bounded);
}

bool separation_ee(const elementary_query *query, const separation *limit, elementary_contact *contact,
                   bool *bounded) {
    return comes_within(query, CSCD_CONTACT_EE, limit, contact, bounded);
}
