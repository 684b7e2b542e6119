/* Which way triangles face their detector points during an interval (Yeh 2012, section 4.4). */
#include "runtime/baselines/published/orientation_check.h"

#include "src/core/vec3.h"

#include <string.h>

void detector_points_move(const own_interval *interval, bool still) {
    culling *c = interval->culling;
    const double *const ends[2] = {interval->swept->x0, interval->swept->x1};
    for (uint32_t r = 0; r < c->region_count; r++)
        for (int e = 0; e < 2; e++)
            memcpy(c->detector_points[r][e], c->detector_offsets[r], sizeof(double[3]));
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) {
        const double share = c->triangle_weights[t] / 3.0;
        for (int e = 0; e < 2; e++) {
            double *point = c->detector_points[c->triangle_regions[t]][e];
            for (int i = 0; i < 3; i++) {
                const double *p = ends[still ? 0 : e] + (size_t)c->mesh->triangles[t][i] * 3;
                for (int k = 0; k < 3; k++) point[k] += share * p[k];
            }
        }
    }
}

/* The Bernstein coefficients of equation 4.2: (p0 - dp) . n is a cubic of time, since n is a quadratic. */
static void orientation_values(const double corners[3][2][3], const double point[2][3], double b[4]) {
    double u[2][3], v[2][3], d[2][3], n[3][3], one[3], other[3];
    for (int e = 0; e < 2; e++) {
        vec3_subtract(corners[1][e], corners[0][e], u[e]);
        vec3_subtract(corners[2][e], corners[0][e], v[e]);
        vec3_subtract(corners[0][e], point[e], d[e]);
        vec3_cross(u[e], v[e], n[2 * e]);
    }
    vec3_cross(u[0], v[1], one);
    vec3_cross(u[1], v[0], other);
    for (int k = 0; k < 3; k++) n[1][k] = 0.5 * (one[k] + other[k]);
    b[0] = vec3_dot(d[0], n[0]);
    b[1] = (vec3_dot(d[1], n[0]) + 2.0 * vec3_dot(d[0], n[1])) / 3.0;
    b[2] = (2.0 * vec3_dot(d[1], n[1]) + vec3_dot(d[0], n[2])) / 3.0;
    b[3] = vec3_dot(d[1], n[2]);
}

/* Equation 4.3. All coefficients above 0 make the value positive during the whole interval. */
static uint8_t orientation_of(const own_interval *interval, uint32_t triangle) {
    const cscd_mesh *mesh = interval->swept->mesh;
    const culling *c = interval->culling;
    double corners[3][2][3], b[4];
    if (!interval->culled[mesh->triangle_components[triangle]] ||
        (interval->clean != NULL && !interval->clean[triangle]))
        return ORIENTATION_ZERO;
    for (int i = 0; i < 3; i++) {
        const size_t at = (size_t)mesh->triangles[triangle][i] * 3;
        memcpy(corners[i][0], interval->swept->x0 + at, sizeof(double[3]));
        memcpy(corners[i][1], interval->swept->x1 + at, sizeof(double[3]));
    }
    orientation_values((const double(*)[2][3])corners,
                       (const double(*)[3])c->detector_points[c->triangle_regions[triangle]], b);
    if (b[0] > 0.0 && b[1] > 0.0 && b[2] > 0.0 && b[3] > 0.0) return ORIENTATION_PLUS;
    if (b[0] < 0.0 && b[1] < 0.0 && b[2] < 0.0 && b[3] < 0.0) return ORIENTATION_MINUS;
    return ORIENTATION_ZERO;
}

void orientations_check(const own_interval *interval) {
    culling *c = interval->culling;
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) c->facing[t] = orientation_of(interval, t);
    culling_begin(c);
}
