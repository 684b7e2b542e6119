/* Products of rows of factors. Each number is the sum over the pivots in their order, whatever the width of vectors, so all levels
 * have the same bits. */
#include "runtime/untangle/front_simd.h"

#include "src/core/simd_wide.h"

#define INLINED static inline __attribute__((always_inline))

INLINED f64w load_lanes(const double *from) {
    f64w v;
    memcpy(&v, from, sizeof v);
    return v;
}

/* A tile of height x vectors, whose sums stay in registers. */
INLINED void subtract_tile(double *out, size_t out_stride, const double *a, const double *b, size_t stride,
                           size_t count, size_t height, size_t vectors) {
    f64w sums[FRONT_STRIP][2];
    for (size_t r = 0; r < height; r++) {
        for (size_t v = 0; v < vectors; v++) sums[r][v] = f64w_all(0.0);
    }
    for (size_t k = 0; k < count; k++, a += stride, b += stride) {
        for (size_t v = 0; v < vectors; v++) {
            const f64w column = load_lanes(b + v * WIDTH);
            for (size_t r = 0; r < height; r++) sums[r][v] += f64w_all(a[r]) * column;
        }
    }
    for (size_t r = 0; r < height; r++) {
        for (size_t v = 0; v < vectors; v++) {
            const f64w changed = load_lanes(out + r * out_stride + v * WIDTH) - sums[r][v];
            memcpy(out + r * out_stride + v * WIDTH, &changed, sizeof changed);
        }
    }
}

INLINED void subtract_strip(double *out, size_t out_stride, const double *a, const double *b, size_t stride,
                            size_t count, size_t height, size_t width) {
    size_t c = 0;
    for (; c + 2 * WIDTH <= width; c += 2 * WIDTH)
        subtract_tile(out + c, out_stride, a, b + c, stride, count, height, 2);
    for (; c < width; c += WIDTH) subtract_tile(out + c, out_stride, a, b + c, stride, count, height, 1);
}

static void subtract_products(double *out, size_t out_stride, const double *a, const double *b, size_t stride,
                              size_t count, size_t height, size_t width) {
    if (height == 4)
        subtract_strip(out, out_stride, a, b, stride, count, 4, width);
    else if (height == 3)
        subtract_strip(out, out_stride, a, b, stride, count, 3, width);
    else if (height == 2)
        subtract_strip(out, out_stride, a, b, stride, count, 2, width);
    else
        subtract_strip(out, out_stride, a, b, stride, count, 1, width);
}

const front_kernels SIMD_NAME(front_kernels) = {subtract_products};
