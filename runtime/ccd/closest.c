/* Points of features at rest: the closest ones, and the vector between two. */
#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"

#include <math.h>
#include <stdbool.h>

/* ---- the closest points -------------------------------------------------------------------------------- */

static double clamp_to_unit(double x) {
    return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
}

/* Returns the parameter of the point of segment a b that is nearest to p, or 0 if the segment is a point. */
static double nearest_on_segment(const double p[3], const double a[3], const double b[3]) {
    double direction[3], offset[3];
    vec3_subtract(b, a, direction);
    vec3_subtract(p, a, offset);
    double length = vec3_dot(direction, direction);
    return length > 0.0 ? clamp_to_unit(vec3_dot(offset, direction) / length) : 0.0;
}

static double squared_distance_at(const double p[3], const double a[3], const double b[3], const double c[3],
                                  double u, double v) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double offset = (p[k] - a[k]) - u * (b[k] - a[k]) - v * (c[k] - a[k]);
        sum += offset * offset;
    }
    return sum;
}

/* Finds the nearest point on the three sides. */
static double closest_on_sides(const double p[3], const double a[3], const double b[3], const double c[3],
                               double *u, double *v) {
    double ab = nearest_on_segment(p, a, b), bc = nearest_on_segment(p, b, c),
           ca = nearest_on_segment(p, c, a);
    const double candidates[3][2] = {{ab, 0.0}, {1.0 - bc, bc}, {0.0, 1.0 - ca}};
    double best = INFINITY;
    for (int i = 0; i < 3; i++) {
        double distance = squared_distance_at(p, a, b, c, candidates[i][0], candidates[i][1]);
        if (distance < best) {
            best = distance;
            *u = candidates[i][0];
            *v = candidates[i][1];
        }
    }
    return best;
}

enum { PROJECTIONS_MAX = 16 };

/* Projects the residual of p at u and v onto the plane, adds the result to u and v, and says whether that
 * changed them. Repeating it makes the point exact up to rounding even in a thin triangle, where the first
 * answer is not. */
static bool add_projection(const double p[3], const double a[3], const double ab[3], const double ac[3],
                           const double normal[3], double area, double *u, double *v) {
    double residual[3], side[3];
    for (int k = 0; k < 3; k++) residual[k] = (p[k] - a[k]) - *u * ab[k] - *v * ac[k];
    vec3_cross(residual, ac, side);
    double step_u = vec3_dot(side, normal) / area;
    vec3_cross(ab, residual, side);
    double step_v = vec3_dot(side, normal) / area, old_u = *u, old_v = *v;
    *u += step_u;
    *v += step_v;
    return *u != old_u || *v != old_v;
}

/* Are u and v, after one projection, so far outside of the triangle that no further one leads into it? A
 * projection is off by less than 2^-44 of Q E |ac| / area in u, and of Q E |ab| / area in v, where E is at
 * least |ab| |ac|, the largest magnitude of the normal, and Q at least what the residual is the sum of:
 * coordinates of the residual are off by 2^-50 Q, those of the normal by 2^-50 E, products and sums with
 * them by a few units more of 2^-53, and area is at most E E. If these errors are at most a half, Q is no
 * less than at all later points, and these are at most twice the errors away. An area of 2^-900 or more
 * keeps what underflow loses below that. */
static bool stays_outside(const double p[3], const double a[3], const double ab[3], const double ac[3],
                          double area, double u, double v) {
    double offset = 0.0, long_ab = 0.0, long_ac = 0.0;
    for (int k = 0; k < 3; k++) {
        offset += fabs(p[k] - a[k]);
        long_ab += fabs(ab[k]);
        long_ac += fabs(ac[k]);
    }
    double sum = offset + (fabs(u) + 1.0) * long_ab + (fabs(v) + 1.0) * long_ac;
    double twice = 0x1p-43 * sum * (long_ab * long_ac);
    double off_u = twice * long_ac, off_v = twice * long_ab; /* times area */
    if (!(area > 0x1p-900 && off_u <= area && off_v <= area)) return false;
    return u * area < -off_u || v * area < -off_v ||
           (u + v - 1.0) * area > off_u + off_v + 0x1p-43 * (1.0 + fabs(u) + fabs(v)) * area;
}

/* A squared distance below this share of the squared lengths is rounding, so no other point is nearer. */
static const double touching = 0x1p-90;

/* Finds the nearest point of the triangle's plane. Returns INFINITY if it is not in the triangle. */
static double closest_in_plane(const double p[3], const double a[3], const double b[3], const double c[3],
                               double *u, double *v, double *size) {
    double ab[3], ac[3], normal[3], inside_u = 0.0, inside_v = 0.0;
    vec3_subtract(b, a, ab);
    vec3_subtract(c, a, ac);
    vec3_cross(ab, ac, normal);
    double area = vec3_dot(normal, normal);
    *size = vec3_dot(ab, ab) + vec3_dot(ac, ac);
    if (!(area > 0.0)) return INFINITY;
    for (int i = 0; i < PROJECTIONS_MAX; i++) {
        if (!add_projection(p, a, ab, ac, normal, area, &inside_u, &inside_v)) break;
        if (i == 0 && stays_outside(p, a, ab, ac, area, inside_u, inside_v)) return INFINITY;
    }
    if (!(inside_u >= 0.0 && inside_v >= 0.0 && inside_u + inside_v <= 1.0)) return INFINITY;
    *u = inside_u;
    *v = inside_v;
    return squared_distance_at(p, a, b, c, inside_u, inside_v);
}

double closest_point_triangle(const double p[3], const double a[3], const double b[3], const double c[3],
                              double *u, double *v) {
    double size, inside_u = 0.0, inside_v = 0.0,
                 distance = closest_in_plane(p, a, b, c, &inside_u, &inside_v, &size);
    double best = distance <= touching * size ? INFINITY : closest_on_sides(p, a, b, c, u, v);
    if (distance > best || !(distance < INFINITY)) return best;
    /* When rounding hides the difference, the inner point is the better one. */
    *u = inside_u;
    *v = inside_v;
    return distance;
}

static double segment_distance_at(const double a0[3], const double a1[3], const double b0[3],
                                  const double b1[3], double u, double v) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double offset = (a0[k] - b0[k]) + u * (a1[k] - a0[k]) - v * (b1[k] - b0[k]);
        sum += offset * offset;
    }
    return sum;
}

/* Starts at the nearest points of the two lines. Between nearly parallel lines they are inexact, and
 * projecting back and forth between the segments corrects that. Returns INFINITY for parallel lines. */
static double closest_on_lines(const double a0[3], const double a1[3], const double b0[3], const double b1[3],
                               double *u, double *v, double *size) {
    double along_a[3], along_b[3], offset[3], normal[3], side[3], point[3];
    vec3_subtract(a1, a0, along_a);
    vec3_subtract(b1, b0, along_b);
    vec3_subtract(b0, a0, offset);
    vec3_cross(along_a, along_b, normal);
    double area = vec3_dot(normal, normal);
    *size = vec3_dot(along_a, along_a) + vec3_dot(along_b, along_b);
    if (!(area > 0.0)) return INFINITY;
    vec3_cross(offset, along_b, side);
    *u = clamp_to_unit(vec3_dot(side, normal) / area);
    vec3_add_scaled(a0, *u, along_a, point);
    *v = nearest_on_segment(point, b0, b1);
    vec3_add_scaled(b0, *v, along_b, point);
    *u = nearest_on_segment(point, a0, a1);
    return segment_distance_at(a0, a1, b0, b1, *u, *v);
}

/* Finds the nearest points of which one is an end. */
static double closest_ends(const double a0[3], const double a1[3], const double b0[3], const double b1[3],
                           double *u, double *v) {
    const double candidates[4][2] = {{0.0, nearest_on_segment(a0, b0, b1)},
                                     {1.0, nearest_on_segment(a1, b0, b1)},
                                     {nearest_on_segment(b0, a0, a1), 0.0},
                                     {nearest_on_segment(b1, a0, a1), 1.0}};
    double best = INFINITY;
    for (int i = 0; i < 4; i++) {
        double distance = segment_distance_at(a0, a1, b0, b1, candidates[i][0], candidates[i][1]);
        if (distance < best) {
            best = distance;
            *u = candidates[i][0];
            *v = candidates[i][1];
        }
    }
    return best;
}

/* The nearest points are two inner points, or one of them is an end. */
double closest_segments(const double a0[3], const double a1[3], const double b0[3], const double b1[3],
                        double *u, double *v) {
    double size, cross_u = 0.0, cross_v = 0.0,
                 distance = closest_on_lines(a0, a1, b0, b1, &cross_u, &cross_v, &size);
    double best = distance <= touching * size ? INFINITY : closest_ends(a0, a1, b0, b1, u, v);
    if (distance > best || !(distance < INFINITY)) return best;
    *u = cross_u;
    *v = cross_v;
    return distance;
}

/* ---- the vector between two points that are named by weights of the four vertices of a pair ------------ */

void connection_between(const double *const x[4], const double weights[4], int own, double out[3]) {
    vec3_subtract(x[0], x[own], out);
    for (int i = 1; i < 4; i++) {
        const double *origin = i < own ? x[0] : x[own];
        if (i == own) continue;
        for (int k = 0; k < 3; k++) out[k] += weights[i] * (x[i][k] - origin[k]);
    }
}

double connection_length(const double vector[3]) {
    double largest = vec3_largest(vector), scaled[3];
    if (!(largest > 0.0)) return 0.0;
    for (int k = 0; k < 3; k++) scaled[k] = vector[k] / largest;
    return largest * sqrt(vec3_dot(scaled, scaled));
}
