/* Vectors of three doubles. */
#pragma once

#include <math.h>
#include <stdbool.h>

static inline double vec3_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vec3_cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void vec3_subtract(const double a[3], const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

/* a += factor * b */
static inline void vec3_add_scaled(double a[3], double factor, const double b[3]) {
    for (int k = 0; k < 3; k++) a[k] += factor * b[k];
}

static inline double vec3_norm(const double a[3]) {
    return sqrt(vec3_dot(a, a));
}

/* Scales to length 1; returns false and leaves the zero vector unchanged. */
static inline bool vec3_normalize(double a[3]) {
    double length = vec3_norm(a);
    if (!(length > 0.0)) return false;
    for (int k = 0; k < 3; k++) a[k] /= length;
    return true;
}
