/* The plane onto which contours are projected, with bounds on what rounding does. */
#pragma once

#include "src/core/vec3.h"

#include <float.h>

/* The plane across the axis, and how far computed coordinates may be from those of the exact projection. Its
 * origin moves with a vertex, because a motion that all vertices share does not bring them together. */
typedef struct plane {
    double origin[2][3], right[3], up[3];
    double error;
} plane;

/* right and up are perpendicular to the axis up to rounding: the exact projection, along right x up, is along
 * an axis that is off by 1e-14 or so, which normal_cone_limit allows for. */
static inline plane plane_across(const float axis[3], const double *start, const double *end) {
    plane p = {.error = 0.0};
    double direction[3], helper[3] = {0.0, 0.0, 0.0}, least = INFINITY, length = 0.0;
    int smallest = 0;
    for (int k = 0; k < 3; k++) {
        direction[k] = (double)axis[k];
        p.origin[0][k] = start[k];
        p.origin[1][k] = end[k];
        if (fabs(direction[k]) < least) {
            least = fabs(direction[k]);
            smallest = k;
        }
    }
    helper[smallest] = 1.0;
    vec3_cross(direction, helper, p.right);
    for (int k = 0; k < 3; k++) length += p.right[k] * p.right[k];
    for (int k = 0; k < 3; k++) p.right[k] /= sqrt(length);
    vec3_cross(direction, p.right, p.up);
    return p;
}

/* A projected coordinate is a sum of three products of differences, so it is off by less than 8 u times their sum. */
static inline void plane_project(plane *p, const double *x, int time, double out[2]) {
    double size = 0.0, from[3];
    for (int k = 0; k < 3; k++) {
        from[k] = x[k] - p->origin[time][k];
        size += fabs(from[k]);
    }
    out[0] = p->right[0] * from[0] + p->right[1] * from[1] + p->right[2] * from[2];
    out[1] = p->up[0] * from[0] + p->up[1] * from[1] + p->up[2] * from[2];
    p->error = max_of(p->error, 8.0 * DBL_EPSILON * size);
}

static inline double plane_cross(const double a[2], const double b[2]) {
    return a[0] * b[1] - a[1] * b[0];
}

/* The error of a coefficient of a product of two such differences. With eps the error of a coordinate, each
 * factor is off by 2 eps (and by rounding, 2^-52 of it, which is less), so each of two terms by 4 eps L + 4
 * eps^2; halving the interval up to eight times adds 16 u L^2, which is less than 4 eps L. */
static inline double plane_product_error(const plane *p, double length) {
    return 24.0 * p->error * length + 16.0 * p->error * p->error;
}
