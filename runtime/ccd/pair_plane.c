/* A plane that certainly lies between two features at rest, and how far apart it certainly keeps them. */

#include "runtime/ccd/exact.h"
#include "runtime/ccd/feature_moment.h"

#include "src/core/vec3.h"

#include <string.h>

/* In units of the scale: what is taken from the difference of two heights (lemma 2), and what is added to
 * the distance of the nearest points (DISTANCE_ERROR of min_separation.c). */
static const double gap_error = 0x1p-47, distance_error = 0x1p-47;

/* A plane that proves so much of what the nearest points allow is not improved on. */
static const double share_proven = 0.985;

/* Below this the direction between the nearest points is only rounding. */
static const double too_near = 0x1p-46;

/* The pair at rest, relative to its first point and scaled by a power of two. */
typedef struct resting_pair {
    feature_moment at;
    double scale;
} resting_pair;

static resting_pair rest_pair(cscd_contact_kind kind, const double x[4][3]) {
    elementary_query query;
    memcpy(query.x0, x, sizeof query.x0);
    memcpy(query.x1, x, sizeof query.x1);
    local_query local = local_query_of(&query, kind, FRAME_AT_REST);
    return (resting_pair){feature_moment_start(&local), local.scale};
}

/* Measures the points along a unit vector, in units of the scale. */
static void measure_along(const feature_moment *m, const double normal[3], pair_plane *out) {
    int first = points_of_first(m->features.kind);
    out->low_a = INFINITY;
    out->high_b = -INFINITY;
    for (int i = 0; i < 4; i++) {
        double height = out->height[i] = vec3_dot(normal, m->features.x[i]);
        if (i < first)
            out->low_a = min_of(out->low_a, height);
        else
            out->high_b = max_of(out->high_b, height);
    }
    out->gap = out->low_a - out->high_b - gap_error;
    memcpy(out->normal, normal, sizeof out->normal);
}

/* Tries planes along fewer and fewer edges until one proves enough. The shortest connection itself is tilted
 * by its rounding, which tells when it is short; an edge that is nearly parallel to another one tilts a
 * plane along both. */
static void find_local_plane(const feature_moment *m, double length, pair_plane *out) {
    double normal[3], enough = share_proven * (m->distance + distance_error - length);
    for (int k = 0; k < 3; k++) normal[k] = m->shortest.offset[k] / m->distance;
    measure_along(m, normal, out);
    for (int axes_max = 2; axes_max > 0 && out->gap - length < enough; axes_max--) {
        pair_plane other = {.gap = 0.0};
        separating_plane plane = separating_plane_find(&m->features, &m->shortest, axes_max);
        measure_along(m, plane.normal, &other);
        if (other.gap > out->gap) *out = other;
    }
    out->distance = m->distance + distance_error;
}

/* The division is exact: all numbers are far from the ends of the range of doubles. */
static void scale_plane(double scale, pair_plane *plane) {
    for (int i = 0; i < 4; i++) plane->height[i] /= scale;
    plane->low_a /= scale;
    plane->high_b /= scale;
    plane->gap /= scale;
    plane->distance /= scale;
}

void pair_plane_find(cscd_contact_kind kind, const double x[4][3], pair_plane *out) {
    resting_pair p = rest_pair(kind, x);
    *out = (pair_plane){.gap = 0.0};
    if (!(p.at.distance > too_near)) return;
    find_local_plane(&p.at, 0.0, out);
    scale_plane(p.scale, out);
}

/* The largest coordinate of points that are relative to the first one. */
static double extent_of_points(const double x[4][3]) {
    double extent = 0.0;
    for (int i = 3; i < 12; i++) extent = max_of(extent, fabs(x[i / 3][i % 3]));
    return extent;
}

/* Rounding does not depend on a scale, which is a power of two, so this works without one: lengths of pairs are from
 * 2^-300 to 2^301, and their squares far from the ends of the range of doubles. A unit of the scale that lemma 2 knows is
 * at most twice the extent. */
bool pair_plane_along(cscd_contact_kind kind, const double x[4][3], const double weights[4],
                      const double direction[3], pair_plane *out) {
    double local[4][3], apart[3] = {0.0, 0.0, 0.0};
    const int first = points_of_first(kind);
    for (int i = 0; i < 4; i++) {
        vec3_subtract(x[i], x[0], local[i]);
        for (int k = 0; k < 3; k++) apart[k] += weights[i] * local[i][k];
    }
    const double error = 2.0 * gap_error * extent_of_points((const double(*)[3])local);
    out->low_a = INFINITY;
    out->high_b = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const double height = out->height[i] = vec3_dot(direction, local[i]);
        if (i < first)
            out->low_a = min_of(out->low_a, height);
        else
            out->high_b = max_of(out->high_b, height);
    }
    memcpy(out->normal, direction, sizeof out->normal);
    out->gap = out->low_a - out->high_b - error;
    out->distance = sqrt(vec3_dot(apart, apart)) + error;
    const bool of_unit_length = fabs(vec3_dot(direction, direction) - 1.0) <= 0x1p-51;
    return of_unit_length && out->gap > 0.0 && out->gap >= share_proven * out->distance;
}

double pair_gap(cscd_contact_kind kind, const double x[4][3], double length) {
    resting_pair p = rest_pair(kind, x);
    double scaled_length = length * p.scale;
    if (p.at.distance > too_near) {
        pair_plane plane;
        find_local_plane(&p.at, scaled_length, &plane);
        double gap = plane.gap - scaled_length;
        if (gap > 0.0 && gap >= share_proven * (plane.distance - scaled_length))
            return gap / p.scale >= 0x1p-352 ? gap / p.scale : 0.0;
        if (plane.distance <= scaled_length) return 0.0;
    }
    return exact_gap(kind, x, length);
}
