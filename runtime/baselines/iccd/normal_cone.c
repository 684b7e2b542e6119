/* Continuous normal cones of triangles and of their unions. */
#include "runtime/baselines/iccd/normal_cone.h"

#include "src/core/vec3.h"

#include <math.h>

static const normal_cone none = {{0.0f, 0.0f, 0.0f}, INFINITY};

/* An upper bound on what rounding in single precision adds to an angle, per operation on cones. */
static const float slack = 4e-6f;

/* Returns an upper bound of the angle between two unit vectors up to a right angle, INFINITY beyond. With the chord
 * c it is 2 asin(c / 2) = c + c^3 / 24 + ...; the quotient of the rest by c^3 grows to 0.055361 at c = sqrt 2. */
static float angle_between(const float a[3], const float b[3]) {
    float squared = 0.0f;
    for (int k = 0; k < 3; k++) squared += (a[k] - b[k]) * (a[k] - b[k]);
    float chord = sqrtf(squared);
    return squared <= 2.0f ? chord * (1.0f + 0.05537f * squared) : INFINITY;
}

static bool normalize_sum(const float sum[3], float out[3]) {
    float squared = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
    if (!(squared > 1e-6f)) return false;
    float inverse = 1.0f / sqrtf(squared);
    for (int k = 0; k < 3; k++) out[k] = sum[k] * inverse;
    return true;
}

/* The two edges of a triangle from its first corner. */
typedef struct edge_pair {
    double first[3], second[3];
} edge_pair;

static edge_pair edges_at(const uint32_t corners[3], const double *x) {
    edge_pair e;
    for (size_t k = 0; k < 3; k++) {
        double origin = x[(size_t)corners[0] * 3 + k];
        e.first[k] = x[(size_t)corners[1] * 3 + k] - origin;
        e.second[k] = x[(size_t)corners[2] * 3 + k] - origin;
    }
    return e;
}

/* Adds a x b; the greatest error of a component is below 2^-50 |a| |b|. */
static double add_cross(const double a[3], const double b[3], double sum[3]) {
    for (int k = 0; k < 3; k++) sum[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    return sqrt(vec3_dot(a, a) * vec3_dot(b, b));
}

/* Computes the direction of a vector that is off by 2^-48 size at most. False if that turns it by 4e-7 or more, or
 * if its squares leave the range of doubles. */
static bool direction_of(const double normal[3], double size, float out[3]) {
    double length = sqrt(vec3_dot(normal, normal));
    if (!(length > 1e-8 * size && length > 1e-150 && length < 1e150)) return false;
    for (int k = 0; k < 3; k++) out[k] = (float)(normal[k] / length);
    return true;
}

static normal_cone cone_around(float (*directions)[3], int count) {
    normal_cone cone = {{0.0f, 0.0f, 0.0f}, slack};
    float sum[3] = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) sum[k] += directions[i][k];
    }
    if (!normalize_sum(sum, cone.axis)) return none;
    for (int i = 0; i < count; i++) {
        float angle = angle_between(cone.axis, directions[i]) + slack;
        if (angle > cone.angle) cone.angle = angle;
    }
    return cone;
}

normal_cone normal_cone_of(const uint32_t corners[3], const double *x0, const double *x1) {
    edge_pair start = edges_at(corners, x0), end = edges_at(corners, x1);
    double normals[3][3] = {{0.0}};
    float directions[3][3];
    double size = add_cross(start.first, start.second, normals[0]);
    if (!direction_of(normals[0], size, directions[0])) return none;
    size = add_cross(end.first, end.second, normals[1]);
    if (!direction_of(normals[1], size, directions[1])) return none;
    size = add_cross(start.first, end.second, normals[2]);
    size += add_cross(end.first, start.second, normals[2]);
    if (!direction_of(normals[2], size, directions[2])) return none;
    normal_cone cone = cone_around(directions, 3);
    return normal_cone_exists(&cone) ? cone : none;
}

normal_cone normal_cone_of_ends(const uint32_t corners[3], const double *x0, const double *x1) {
    edge_pair start = edges_at(corners, x0), end = edges_at(corners, x1);
    double normals[2][3] = {{0.0}};
    float directions[2][3];
    double size = add_cross(start.first, start.second, normals[0]);
    if (!direction_of(normals[0], size, directions[0])) return none;
    size = add_cross(end.first, end.second, normals[1]);
    if (!direction_of(normals[1], size, directions[1])) return none;
    return cone_around(directions, 2);
}

normal_cone normal_cone_union(const normal_cone *a, const normal_cone *b, float limit) {
    normal_cone cone;
    float sum[3];
    if (!(a->angle < limit && b->angle < limit)) return none;
    for (int k = 0; k < 3; k++) sum[k] = a->axis[k] + b->axis[k];
    if (!normalize_sum(sum, cone.axis)) return none;
    float to_a = angle_between(cone.axis, a->axis) + a->angle;
    float to_b = angle_between(cone.axis, b->axis) + b->angle;
    cone.angle = (to_a > to_b ? to_a : to_b) + slack;
    return cone.angle < limit ? cone : none;
}
