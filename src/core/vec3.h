/* Vectors of three doubles. Every sum is formed from left to right, x + y + z: results depend on that
 * order. */
#pragma once

#include "src/core/floating.h"

#include <math.h>

static inline void vec3_subtract(const double a[3], const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

/* a + s b */
static inline void vec3_add_scaled(const double a[3], double s, const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] + s * b[k];
}

static inline double vec3_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vec3_cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double vec3_squared_distance(const double a[3], const double b[3]) {
    double difference[3];
    vec3_subtract(a, b, difference);
    return vec3_dot(difference, difference);
}

/* The largest magnitude of the three coordinates. */
static inline double vec3_largest(const double a[3]) {
    return max_of(fabs(a[0]), max_of(fabs(a[1]), fabs(a[2])));
}

/* ---- the directions of 14-DOPs; the first three are those of boxes ------------------------------------- */

enum { BOX_AXES = 3, KDOP_AXES = 7 };

/* x, y, z, x+y+z, x+y-z, x-y+z, -x+y+z. Vector code writes these sums out, in this order. */
static const double kdop_axes[KDOP_AXES][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                               {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

static inline double kdop_along(const double v[3], int axis) {
    return kdop_axes[axis][0] * v[0] + kdop_axes[axis][1] * v[1] + kdop_axes[axis][2] * v[2];
}
