/* Distances from bodies, and how often they wind around a point, triangle by triangle. */
#include "tests/support/intersections/body_measures.h"

#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"

#include <math.h>

static const double *corner_of_body(const body_rig *r, uint32_t triangle, uint32_t i) {
    return r->all.x0 + (size_t)r->all.triangles[triangle * 3 + i] * 3;
}

double body_distance(const body_rig *r, uint32_t body, const double x[3]) {
    double least = INFINITY, u, v;
    for (uint32_t i = 0; i < r->bodies[body].triangle_count; i++) {
        uint32_t t = r->bodies[body].first_triangle + i;
        least = fmin(least, closest_point_triangle(x, corner_of_body(r, t, 0), corner_of_body(r, t, 1),
                                                   corner_of_body(r, t, 2), &u, &v));
    }
    return sqrt(least);
}

int body_number(const body_rig *r, uint32_t body, const double x[3]) {
    double sum = 0.0; /* of solid angles: van Oosterom and Strackee 1983 */
    for (uint32_t t = 0; t < r->bodies[body].triangle_count; t++) {
        double p[3][3], length[3], cross[3];
        for (uint32_t i = 0; i < 3; i++) {
            vec3_subtract(corner_of_body(r, r->bodies[body].first_triangle + t, i), x, p[i]);
            length[i] = sqrt(vec3_dot(p[i], p[i]));
        }
        vec3_cross(p[1], p[2], cross);
        double bottom = length[0] * length[1] * length[2] + vec3_dot(p[0], p[1]) * length[2] +
                        vec3_dot(p[1], p[2]) * length[0] + vec3_dot(p[2], p[0]) * length[1];
        sum += 2.0 * atan2(vec3_dot(p[0], cross), bottom);
    }
    return (int)lround(sum / (4.0 * acos(-1.0)));
}
