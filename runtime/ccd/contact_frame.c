/* Describes a contact: a time that is safe to step to, the points and the normal. */

#include "runtime/ccd/elementary_levels.h"

#include "src/core/vec3.h"

/* A caller that steps to a time computes positions in doubles, which are off by at most 2 units in the last
 * place of the largest coordinate C, 2^-52 C each. With four points at the gap, two on either side of it, and
 * the diagonal of the cube, the error along the normal is less than 2 * 2 * sqrt(3) * 2^-52 C < 2^-49 C.
 * Twice that is left open. */
static const double gap_left = 0x1p-48;
static const double earlier_at_most = 0x1p-32;

/* Vectors between the points at one moment, as in point_vectors. Blending differences keeps the shape of
 * features that are small compared with their motion; blending positions would not. */
typedef struct moment_vectors {
    double a[3], b[3], c[3];
} moment_vectors;

static double largest_coordinate(const elementary_query *query) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++)
        largest = max_of(largest, max_of(vec3_largest(query->x0[i]), vec3_largest(query->x1[i])));
    return largest;
}

static double blend_ends(double start, double end, double t) {
    return (1.0 - t) * start + t * end;
}

static moment_vectors vectors_at(const point_vectors *v, double t) {
    moment_vectors m;
    for (int k = 0; k < 3; k++) {
        m.a[k] = blend_ends(v->a[0][k], v->a[1][k], t);
        m.b[k] = blend_ends(v->b[0][k], v->b[1][k], t);
        m.c[k] = blend_ends(v->c[0][k], v->c[1][k], t);
    }
    return m;
}

/* Multiplies v by the power of two that brings its largest component to [1/2, 1), so that squares neither
 * over- nor underflow. Returns the exponent that is taken out. */
static int scale_to_one(const double v[3], double out[3]) {
    int exponent = exponent_of(vec3_largest(v));
    double factor = power_of_two(-exponent);
    for (int k = 0; k < 3; k++) out[k] = factor * v[k];
    return exponent;
}

/* Writes a x b times 2^-*exponent. */
static void scaled_cross(const moment_vectors *m, double out[3], int *exponent) {
    double a[3], b[3];
    *exponent = scale_to_one(m->a, a) + scale_to_one(m->b, b);
    vec3_cross(a, b, out);
}

/* Returns an earlier time, at which a gap is left. The gap is the volume over the area of the features'
 * parallelogram, and it closes at the rate of the volume's slope over this area. When the slope is lost in
 * rounding, the root is not simple, and an earlier time gains nothing. */
static double leave_gap(const point_vectors *vectors, double coordinate, const coplanarity *f, double toi) {
    double cross[3], slope = fabs(cubic_slope(f, toi));
    int exponent;
    if (!(slope > 8.0 * f->error)) return toi;
    moment_vectors m = vectors_at(vectors, toi);
    scaled_cross(&m, cross, &exponent);
    double speed = slope * power_of_two(-exponent) / sqrt(vec3_dot(cross, cross));
    return max_of(toi - min_of(gap_left * coordinate / speed, earlier_at_most), 0.0);
}

/* Finds the nearest points at one moment. The vectors are scaled, and relative to the face's first corner
 * (VF) or to the start of the shorter edge (EE), so that its shape survives the addition. */
static void find_parameters(const moment_vectors *m, cscd_contact_kind kind, elementary_contact *contact) {
    static const double origin[3] = {0, 0, 0};
    double a[3], b[3], c[3], end[3];
    double largest = max_of(vec3_largest(m->a), max_of(vec3_largest(m->b), vec3_largest(m->c)));
    double factor = power_of_two(-exponent_of(largest));
    for (int k = 0; k < 3; k++) {
        a[k] = factor * m->a[k];
        b[k] = factor * m->b[k];
        c[k] = factor * m->c[k];
    }
    if (kind == CSCD_CONTACT_VF) {
        closest_point_triangle(c, origin, a, b, &contact->u, &contact->v);
    } else if (vec3_largest(a) < vec3_largest(b)) {
        vec3_add_scaled(c, 1.0, b, end);
        closest_segments(origin, a, c, end, &contact->u, &contact->v);
    } else {
        for (int k = 0; k < 3; k++) c[k] = -c[k];
        vec3_add_scaled(c, 1.0, a, end);
        closest_segments(c, end, origin, b, &contact->u, &contact->v);
    }
}

/* Writes the vector from the point that u and v name on b to the one that they name on a. */
static void connect_points(const double a[3], const double b[3], const double c[3], cscd_contact_kind kind,
                           const elementary_contact *contact, double out[3]) {
    double sign = kind == CSCD_CONTACT_VF ? 1.0 : -1.0;
    for (int k = 0; k < 3; k++) out[k] = sign * (c[k] - contact->u * a[k]) - contact->v * b[k];
}

/* Writes the unit normal of the touching features, turned against the motion of a relative to b. */
static void contact_normal(const point_vectors *v, const moment_vectors *m, cscd_contact_kind kind,
                           const elementary_contact *contact, double normal[3]) {
    double cross[3], start[3], end[3], motion[3];
    int exponent;
    scaled_cross(m, cross, &exponent);
    scale_to_one(cross, normal);
    double length = sqrt(vec3_dot(normal, normal));
    connect_points(v->a[0], v->b[0], v->c[0], kind, contact, start);
    connect_points(v->a[1], v->b[1], v->c[1], kind, contact, end);
    vec3_subtract(end, start, motion);
    double sign = vec3_dot(normal, motion) > 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 3; k++) normal[k] = length > 0.0 ? sign * normal[k] / length : 0.0;
}

void contact_frame_describe(const elementary_query *query, cscd_contact_kind kind, const coplanarity *f,
                            double toi, elementary_contact *contact) {
    point_vectors vectors;
    double apart[3];
    point_vectors_from(query, kind, &vectors);
    contact->toi = leave_gap(&vectors, largest_coordinate(query), f, toi);
    moment_vectors m = vectors_at(&vectors, contact->toi);
    find_parameters(&m, kind, contact);
    connect_points(m.a, m.b, m.c, kind, contact, apart);
    for (int k = 0; k < 3; k++) {
        double on_a = blend_ends(query->x0[0][k], query->x1[0][k], contact->toi);
        if (kind == CSCD_CONTACT_EE) on_a += contact->u * m.a[k];
        contact->point[k] = on_a - 0.5 * apart[k];
    }
    contact_normal(&vectors, &m, kind, contact, contact->normal);
}
