/* The operations of src/core/simd.h behind plain arrays, compiled once per instruction set. */
#include "tests/core/simd_operations.h"

#include "src/core/simd.h"
#include "src/core/simd_wide.h"

static f64x8 load_f64(const double *from) {
    f64x8 v;
    memcpy(&v, from, sizeof v);
    return v;
}

static void store_f64(double *to, f64x8 v) {
    memcpy(to, &v, sizeof v);
}

static f64w load_wide(const double *from) {
    f64w v;
    memcpy(&v, from, sizeof v);
    return v;
}

static void store_wide(double *to, f64w v) {
    memcpy(to, &v, sizeof v);
}

/* ---- eight floats -------------------------------------------------------------------------------------- */

static void f32_min(const float *a, const float *b, float *out) {
    f32x8_store(out, f32x8_min(f32x8_load(a), f32x8_load(b)));
}

static void f32_max(const float *a, const float *b, float *out) {
    f32x8_store(out, f32x8_max(f32x8_load(a), f32x8_load(b)));
}

static void f32_abs(const float *a, float *out) {
    f32x8_store(out, f32x8_abs(f32x8_load(a)));
}

static void f32_sqrt(const float *a, float *out) {
    f32x8_store(out, f32x8_sqrt(f32x8_load(a)));
}

static uint32_t f32_below(const float *a, const float *b) {
    return f32x8_below(f32x8_load(a), f32x8_load(b));
}

static float f32_least(const float *a) {
    return f32x8_least(f32x8_load(a));
}

static float f32_greatest(const float *a) {
    return f32x8_greatest(f32x8_load(a));
}

static void f32_transpose(const float (*rows)[8], float (*out)[8]) {
    f32x8 r[8];
    for (int i = 0; i < 8; i++) r[i] = f32x8_load(rows[i]);
    f32x8_transpose(r);
    for (int i = 0; i < 8; i++) f32x8_store(out[i], r[i]);
}

static uint32_t i32_negative(const uint32_t *a) {
    return i32x8_negative(i32x8_load(a));
}

static void i32_equal(const uint32_t *a, const uint32_t *b, int32_t *out) {
    i32x8 equal = i32x8_equal(i32x8_load(a), i32x8_load(b));
    memcpy(out, &equal, sizeof equal);
}

static void f32_above(const float *a, const float *b, int32_t *out) {
    i32x8 above = f32x8_above(f32x8_load(a), f32x8_load(b));
    memcpy(out, &above, sizeof above);
}

/* ---- eight doubles ------------------------------------------------------------------------------------- */

static void f64_min(const double *a, const double *b, double *out) {
    store_f64(out, f64x8_min(load_f64(a), load_f64(b)));
}

static void f64_max(const double *a, const double *b, double *out) {
    store_f64(out, f64x8_max(load_f64(a), load_f64(b)));
}

static void f64_abs(const double *a, double *out) {
    store_f64(out, f64x8_abs(load_f64(a)));
}

static void f64_sqrt(const double *a, double *out) {
    store_f64(out, f64x8_sqrt(load_f64(a)));
}

static uint32_t f64_below(const double *a, const double *b) {
    return f64x8_below(load_f64(a), load_f64(b));
}

static void to_f32(const double *a, float *out) {
    f32x8_store(out, f32x8_from(load_f64(a)));
}

static void to_f64(const float *a, double *out) {
    store_f64(out, f64x8_from(f32x8_load(a)));
}

static void f64_load_points(const double *positions, const uint32_t *indices, double (*out)[8]) {
    f64x8 points[3];
    f64x8_load_points(positions, indices, points);
    for (int k = 0; k < 3; k++) store_f64(out[k], points[k]);
}

/* ---- as many doubles as the level takes at once ---------------------------------------------------------
 */

static void wide_min(const double *a, const double *b, double *out) {
    for (int i = 0; i < LANES; i += WIDTH) store_wide(out + i, f64w_min(load_wide(a + i), load_wide(b + i)));
}

static void wide_max(const double *a, const double *b, double *out) {
    for (int i = 0; i < LANES; i += WIDTH) store_wide(out + i, f64w_max(load_wide(a + i), load_wide(b + i)));
}

static void wide_abs(const double *a, double *out) {
    for (int i = 0; i < LANES; i += WIDTH) store_wide(out + i, f64w_abs(load_wide(a + i)));
}

static void wide_sqrt(const double *a, double *out) {
    for (int i = 0; i < LANES; i += WIDTH) store_wide(out + i, f64w_sqrt(load_wide(a + i)));
}

static uint32_t wide_below(const double *a, const double *b) {
    uint32_t lanes = 0;
    for (int i = 0; i < LANES; i += WIDTH) lanes |= f64w_below(load_wide(a + i), load_wide(b + i)) << i;
    return lanes;
}

static uint32_t wide_at_most(const double *a, const double *b) {
    uint32_t lanes = 0;
    for (int i = 0; i < LANES; i += WIDTH) lanes |= f64w_at_most(load_wide(a + i), load_wide(b + i)) << i;
    return lanes;
}

static void wide_select(uint32_t lanes, const double *a, const double *b, double *out) {
    for (int i = 0; i < LANES; i += WIDTH)
        store_wide(out + i, f64w_select(lanes >> i & ALL_WIDTH, load_wide(a + i), load_wide(b + i)));
}

static void wide_all(double x, double *out) {
    for (int i = 0; i < LANES; i += WIDTH) store_wide(out + i, f64w_all(x));
}

static void load_points_x8(const double *positions, const uint32_t *indices, double (*out)[8]) {
    for (int i = 0; i < LANES; i += WIDTH) {
        f64w points[3];
        f64w_load_points(positions, indices + i, points);
        for (int k = 0; k < 3; k++) store_wide(out[k] + i, points[k]);
    }
}

static void load_and_store_quads(double (*rows)[4], double (*columns)[8], double (*back)[4]) {
    for (int i = 0; i < LANES; i += WIDTH) {
        const double *from[WIDTH];
        double *to[WIDTH];
        f64w quads[4];
        for (int lane = 0; lane < WIDTH; lane++) {
            from[lane] = rows[i + lane];
            to[lane] = back[i + lane];
        }
        f64w_load_quads(from, quads);
        for (int k = 0; k < 4; k++) store_wide(columns[k] + i, quads[k]);
        f64w_store_quads(quads, to);
    }
}

const simd_operations SIMD_NAME(simd_operations) = {
    .level = SIMD_LEVEL,
    .f32_min = f32_min,
    .f32_max = f32_max,
    .f32_abs = f32_abs,
    .f32_sqrt = f32_sqrt,
    .f32_below = f32_below,
    .f32_least = f32_least,
    .f32_greatest = f32_greatest,
    .f32_transpose = f32_transpose,
    .i32_negative = i32_negative,
    .i32_equal = i32_equal,
    .f32_above = f32_above,
    .f64_min = f64_min,
    .f64_max = f64_max,
    .f64_abs = f64_abs,
    .f64_sqrt = f64_sqrt,
    .f64_below = f64_below,
    .to_f32 = to_f32,
    .to_f64 = to_f64,
    .f64_load_points = f64_load_points,
    .f64w_min = wide_min,
    .f64w_max = wide_max,
    .f64w_abs = wide_abs,
    .f64w_sqrt = wide_sqrt,
    .f64w_below = wide_below,
    .f64w_at_most = wide_at_most,
    .f64w_select = wide_select,
    .f64w_all = wide_all,
    .f64w_load_points = load_points_x8,
    .f64w_quads = load_and_store_quads,
};
