/* Vectors of three doubles. */
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

static inline void vector_subtract(const double a[3], const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

/* a + s b */
static inline void vector_add_scaled(const double a[3], double s, const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] + s * b[k];
}

static inline double vector_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vector_cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Without the care for NaN that makes fmax a function call. */
static inline double larger(double a, double b) {
    return a > b ? a : b;
}

static inline double smaller(double a, double b) {
    return a < b ? a : b;
}

/* e, where x = m 2^e with m in [1/2, 1), as by frexp, which is a function call; 0 for numbers below the
 * normal range. */
static inline int exponent_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int biased = (int)(bits >> 52 & 0x7ff);
    return biased == 0 ? 0 : biased - 1022;
}

/* 2^e, e from -1022 to 1023. */
static inline double power_of_two(int e) {
    uint64_t bits = (uint64_t)(e + 1023) << 52;
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline double vector_largest(const double a[3]) {
    return larger(fabs(a[0]), larger(fabs(a[1]), fabs(a[2])));
}
