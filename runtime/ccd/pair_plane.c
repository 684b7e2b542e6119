/* A plane that certainly lies between two features at rest, and how far apart it certainly keeps them. */
#include "runtime/ccd/pair_plane.h"

#include "runtime/ccd/closest.h"
#include "runtime/ccd/exact/exact_gap.h"
#include "runtime/ccd/separating_plane.h"
#include "src/core/vec3.h"

#include <string.h>

/* In units of the scale: what is taken from the difference of two heights (lemma 2), and what is added to the distance
 * of the nearest points (DISTANCE_ERROR of min_separation.c). */
static const double gap_error = 0x1p-47, distance_error = 0x1p-47;

/* A plane that proves so much of what the nearest points allow is not improved on. */
static const double share_proven = 0.985;

/* Below this the direction between the nearest points is only rounding. */
static const double too_near = 0x1p-46;

/* The pair relative to its first point, scaled by a power of two to an extent in [1/2, 1). */
typedef struct local_pair {
    moving_features features; /* at rest */
    shortest_connection shortest;
    double scale, distance; /* of the nearest points */
} local_pair;

static double pair_extent(const double x[4][3]) {
    double largest = 0.0;
    for (int i = 1; i < 4; i++) {
        for (int k = 0; k < 3; k++) largest = max_of(largest, fabs(x[i][k] - x[0][k]));
    }
    return largest;
}

static void connect_vertex_face(local_pair *p) {
    const double(*x)[3] = (const double(*)[3])p->features.x;
    double u, v;
    closest_point_triangle(x[0], x[1], x[2], x[3], &u, &v);
    for (int k = 0; k < 3; k++)
        p->shortest.offset[k] = (x[0][k] - x[1][k]) - u * (x[2][k] - x[1][k]) - v * (x[3][k] - x[1][k]);
    bool on_last = u + v >= 1.0;
    p->shortest.inside[0] = u > 0.0 && u < 1.0 && !(on_last && v > 0.0);
    p->shortest.inside[1] = v > 0.0 && v < 1.0 && !(on_last && u > 0.0);
    p->shortest.inside[2] = u > 0.0 && v > 0.0 && on_last;
}

static void connect_edges(local_pair *p) {
    const double(*x)[3] = (const double(*)[3])p->features.x;
    double u, v;
    closest_segments(x[0], x[1], x[2], x[3], &u, &v);
    for (int k = 0; k < 3; k++)
        p->shortest.offset[k] = (x[0][k] - x[2][k]) + u * (x[1][k] - x[0][k]) - v * (x[3][k] - x[2][k]);
    p->shortest.inside[0] = u > 0.0 && u < 1.0;
    p->shortest.inside[1] = v > 0.0 && v < 1.0;
}

static local_pair localise_pair(cscd_contact_kind kind, const double x[4][3]) {
    local_pair p = {.features = {.kind = kind}};
    int exponent;
    frexp(pair_extent(x), &exponent);
    p.scale = ldexp(1.0, -exponent);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) p.features.x[i][k] = (x[i][k] - x[0][k]) * p.scale;
    }
    (kind == CSCD_CONTACT_VF ? connect_vertex_face : connect_edges)(&p);
    p.distance = sqrt(vec3_dot(p.shortest.offset, p.shortest.offset));
    return p;
}

/* Measures the points along a unit vector, in units of the scale. */
static void measure_along(const local_pair *p, const double normal[3], pair_plane *out) {
    int first = points_of_first(p->features.kind);
    out->low_a = INFINITY;
    out->high_b = -INFINITY;
    for (int i = 0; i < 4; i++) {
        double height = out->height[i] = vec3_dot(normal, p->features.x[i]);
        if (i < first)
            out->low_a = min_of(out->low_a, height);
        else
            out->high_b = max_of(out->high_b, height);
    }
    out->gap = out->low_a - out->high_b - gap_error;
    memcpy(out->normal, normal, sizeof out->normal);
}

/* Tries planes along fewer and fewer edges until one proves enough. The shortest connection itself is tilted by its
 * rounding, which tells when it is short; an edge that is nearly parallel to another one tilts a plane along both. */
static void find_local_plane(const local_pair *p, double length, pair_plane *out) {
    double normal[3], enough = share_proven * (p->distance + distance_error - length);
    for (int k = 0; k < 3; k++) normal[k] = p->shortest.offset[k] / p->distance;
    measure_along(p, normal, out);
    for (int axes_max = 2; axes_max > 0 && out->gap - length < enough; axes_max--) {
        pair_plane other = {.gap = 0.0};
        separating_plane plane = separating_plane_find(&p->features, &p->shortest, axes_max);
        measure_along(p, plane.normal, &other);
        if (other.gap > out->gap) *out = other;
    }
    out->distance = p->distance + distance_error;
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
    local_pair p = localise_pair(kind, x);
    *out = (pair_plane){.gap = 0.0};
    if (!(p.distance > too_near)) return;
    find_local_plane(&p, 0.0, out);
    scale_plane(p.scale, out);
}

double pair_gap(cscd_contact_kind kind, const double x[4][3], double length) {
    local_pair p = localise_pair(kind, x);
    double scaled_length = length * p.scale;
    if (p.distance > too_near) {
        pair_plane plane;
        find_local_plane(&p, scaled_length, &plane);
        double gap = plane.gap - scaled_length;
        if (gap > 0.0 && gap >= share_proven * (plane.distance - scaled_length))
            return gap / p.scale >= 0x1p-352 ? gap / p.scale : 0.0;
        if (plane.distance <= scaled_length) return 0.0;
    }
    return exact_gap(kind, x, length);
}
