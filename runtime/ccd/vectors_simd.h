/* Products of many vectors of three doubles, summed up from left to right as in vec3.h. */
#pragma once

#include "src/core/simd_wide.h"

static inline void cross_x8(const f64w a[3], const f64w b[3], f64w out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline f64w dot_x8(const f64w a[3], const f64w b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
