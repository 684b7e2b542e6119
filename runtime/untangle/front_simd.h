/* The kernels of fronts, compiled once per instruction set. */
#pragma once

#include "src/core/kernels.h"

#include <stddef.h>

/* At most this number of rows are changed at once. */
enum { FRONT_STRIP = 4 };

typedef struct front_kernels {
    /* out[r][c] -= the sum over k of a[k][r] b[k][c], for `height` rows, at most FRONT_STRIP, and `width` columns, a multiple of
     * FRONT_ALIGNMENT. All rows of a and b are `stride` apart, those of out `out_stride`. */
    void (*subtract)(double *out, size_t out_stride, const double *a, const double *b, size_t stride,
                     size_t count, size_t height, size_t width);
} front_kernels;

DECLARE_KERNELS(front_kernels);
