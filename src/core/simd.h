/* Vectors of eight numbers: the one place that knows processors, together with simd_neon.h and simd_wide.h.
 *
 * A source that includes this is compiled once per level (see the Makefile). It does the same IEEE operations
 * in the same order on each, none of them fused, so results do not depend on the level. Vectors are the
 * compiler's own (+ - * / and [] work on them); the other operations are below. A set of lanes is the low
 * eight bits of a uint32_t, bit i for lane i. A NaN is neither below nor above anything.
 *
 * All types and operations exist on every level, as this:
 *
 *     type   elements     scalar                 AVX2            AVX-512         NEON
 *     f32x8  8 floats     compiler's vectors     one register    one register    two registers
 *     i32x8  8 int32_t    compiler's vectors     one register    one register    two registers
 *     f64x4  4 doubles    compiler's vectors     one register    one register    two registers
 *     f64x8  8 doubles    compiler's vectors     two registers   one register    four registers
 *     i64x8  8 int64_t    compiler's vectors     two registers   one register    four registers
 *     f64w   WIDTH        2 doubles              4 doubles       8 doubles       2 doubles
 *     i64w   WIDTH        2 int64_t              4 int64_t       8 int64_t       2 int64_t
 *
 *     operation                     f32x8  i32x8  f64x4  f64x8  f64w   on the scalar level
 *     load                          x      x                           memcpy
 *     store                         x                                  memcpy
 *     all (one value in all lanes)  x      x             x      x      the same
 *     abs                           x                    x      x      masks of bits
 *     from (conversion)             x                    x             the same
 *     min, max                      x                    x      x      masks of comparisons
 *     below (lanes with a < b)      x                    x      x      loop over the lanes
 *     at_most (lanes with a <= b)                               x      loop over the lanes
 *     negative (lanes)                     x                           loop over the lanes
 *     equal, above (masks of bits)  above  equal                       the same
 *     select                                                    x      masks
 *     sqrt                          x                    x      x      sqrt of each lane
 *     load_point                                  x                    three loads
 *     load_points                                        x      x      the same; two points
 *
 * f64w and i64w are in simd_wide.h; simd_lanes.h has the operations across lanes.
 */
#pragma once

#include "src/core/floating.h"
#include "src/core/kernels.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define SIMD_SCALAR 0
#define SIMD_AVX2   1
#define SIMD_AVX512 2
#define SIMD_NEON   3

#ifndef SIMD_LEVEL
#define SIMD_LEVEL SIMD_SCALAR
#endif

/* The name that a function or table has on the level that is compiled. */
#if SIMD_LEVEL == SIMD_NEON
#define SIMD_NAME(name) name##_neon
#elif SIMD_LEVEL == SIMD_AVX512
#define SIMD_NAME(name) name##_avx512
#elif SIMD_LEVEL == SIMD_AVX2
#define SIMD_NAME(name) name##_avx2
#else
#define SIMD_NAME(name) name##_scalar
#endif

#if SIMD_LEVEL == SIMD_AVX2 || SIMD_LEVEL == SIMD_AVX512
#include <immintrin.h>
#endif

typedef float f32x8 __attribute__((vector_size(32)));
typedef int32_t i32x8 __attribute__((vector_size(32)));
typedef double f64x4 __attribute__((vector_size(32)));
typedef double f64x8 __attribute__((vector_size(64)));
typedef int64_t i64x8 __attribute__((vector_size(64)));

static inline f32x8 f32x8_load(const float *from) {
    f32x8 v;
    memcpy(&v, from, sizeof v);
    return v;
}

static inline i32x8 i32x8_load(const uint32_t *from) {
    i32x8 v;
    memcpy(&v, from, sizeof v);
    return v;
}

static inline void f32x8_store(float *to, f32x8 v) {
    memcpy(to, &v, sizeof v);
}

static inline f32x8 f32x8_all(float x) {
    return (f32x8){x, x, x, x, x, x, x, x};
}

static inline i32x8 i32x8_all(int32_t x) {
    return (i32x8){x, x, x, x, x, x, x, x};
}

static inline f64x8 f64x8_all(double x) {
    return (f64x8){x, x, x, x, x, x, x, x};
}

/* Rounds to nearest. */
static inline f32x8 f32x8_from(f64x8 v) {
    return __builtin_convertvector(v, f32x8);
}

static inline f64x8 f64x8_from(f32x8 v) {
    return __builtin_convertvector(v, f64x8);
}

#if SIMD_LEVEL == SIMD_NEON

#include "src/core/simd_neon.h"

#else

static inline f32x8 f32x8_abs(f32x8 v) {
    return (f32x8)((i32x8)v & INT32_MAX);
}

static inline f64x8 f64x8_abs(f64x8 v) {
    return (f64x8)((i64x8)v & INT64_MAX);
}

/* ---- minimum, maximum, comparison -------------------------------------------------------------------- */

/* All bits of a lane are set, or none. */
static inline i32x8 i32x8_equal(i32x8 a, i32x8 b) {
    return a == b;
}

static inline i32x8 f32x8_above(f32x8 a, f32x8 b) {
    return a > b;
}

#if SIMD_LEVEL != SIMD_SCALAR

static inline f32x8 f32x8_sqrt(f32x8 v) {
    return _mm256_sqrt_ps(v);
}

/* All of these give b if one of the two is NaN. */
static inline f32x8 f32x8_min(f32x8 a, f32x8 b) {
    return _mm256_min_ps(a, b);
}

static inline f32x8 f32x8_max(f32x8 a, f32x8 b) {
    return _mm256_max_ps(a, b);
}

#else

static inline f32x8 f32x8_sqrt(f32x8 v) {
    for (int i = 0; i < LANES; i++) v[i] = sqrtf(v[i]);
    return v;
}

static inline f32x8 f32x8_min(f32x8 a, f32x8 b) {
    i32x8 below = a < b;
    return (f32x8)(((i32x8)a & below) | ((i32x8)b & ~below));
}

static inline f32x8 f32x8_max(f32x8 a, f32x8 b) {
    i32x8 above = a > b;
    return (f32x8)(((i32x8)a & above) | ((i32x8)b & ~above));
}

#endif

#if SIMD_LEVEL == SIMD_AVX512

static inline f64x8 f64x8_sqrt(f64x8 v) {
    return _mm512_sqrt_pd(v);
}

static inline f64x8 f64x8_min(f64x8 a, f64x8 b) {
    return _mm512_min_pd(a, b);
}

static inline f64x8 f64x8_max(f64x8 a, f64x8 b) {
    return _mm512_max_pd(a, b);
}

static inline uint32_t f32x8_below(f32x8 a, f32x8 b) {
    return _cvtmask8_u32(_mm256_cmp_ps_mask(a, b, _CMP_LT_OQ));
}

static inline uint32_t f64x8_below(f64x8 a, f64x8 b) {
    return _cvtmask8_u32(_mm512_cmp_pd_mask(a, b, _CMP_LT_OQ));
}

static inline uint32_t i32x8_negative(i32x8 v) {
    return _cvtmask8_u32(_mm256_movepi32_mask((__m256i)v));
}

#else

static inline f64x8 f64x8_min(f64x8 a, f64x8 b) {
    i64x8 below = a < b;
    return (f64x8)(((i64x8)a & below) | ((i64x8)b & ~below));
}

static inline f64x8 f64x8_max(f64x8 a, f64x8 b) {
    i64x8 above = a > b;
    return (f64x8)(((i64x8)a & above) | ((i64x8)b & ~above));
}

#if SIMD_LEVEL == SIMD_AVX2

static inline f64x8 f64x8_sqrt(f64x8 v) {
    f64x4 low = _mm256_sqrt_pd(__builtin_shufflevector(v, v, 0, 1, 2, 3));
    f64x4 high = _mm256_sqrt_pd(__builtin_shufflevector(v, v, 4, 5, 6, 7));
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

static inline uint32_t f32x8_below(f32x8 a, f32x8 b) {
    return (uint32_t)_mm256_movemask_ps((f32x8)(a < b));
}

static inline uint32_t i32x8_negative(i32x8 v) {
    return (uint32_t)_mm256_movemask_ps((f32x8)v);
}

static inline uint32_t f64x8_below(f64x8 a, f64x8 b) {
    i64x8 below = a < b;
    f64x8 signs = (f64x8)below;
    f64x4 low = __builtin_shufflevector(signs, signs, 0, 1, 2, 3);
    f64x4 high = __builtin_shufflevector(signs, signs, 4, 5, 6, 7);
    return (uint32_t)_mm256_movemask_pd(low) | (uint32_t)_mm256_movemask_pd(high) << 4;
}

#else

static inline f64x8 f64x8_sqrt(f64x8 v) {
    for (int i = 0; i < LANES; i++) v[i] = sqrt(v[i]);
    return v;
}

static inline uint32_t f32x8_below(f32x8 a, f32x8 b) {
    uint32_t lanes = 0;
    for (int i = 0; i < LANES; i++) lanes |= (uint32_t)(a[i] < b[i]) << i;
    return lanes;
}

static inline uint32_t i32x8_negative(i32x8 v) {
    uint32_t lanes = 0;
    for (int i = 0; i < LANES; i++) lanes |= (uint32_t)(v[i] < 0) << i;
    return lanes;
}

static inline uint32_t f64x8_below(f64x8 a, f64x8 b) {
    uint32_t lanes = 0;
    for (int i = 0; i < LANES; i++) lanes |= (uint32_t)(a[i] < b[i]) << i;
    return lanes;
}

#endif
#endif

/* ---- points ------------------------------------------------------------------------------------------ */

/* Loads x, y, z and an arbitrary fourth value; reads only three doubles. */
static inline f64x4 f64x4_load_point(const double *from) {
#if SIMD_LEVEL == SIMD_SCALAR
    return (f64x4){from[0], from[1], from[2], 0.0};
#else
    return _mm256_maskload_pd(from, _mm256_setr_epi64x(-1, -1, -1, 0));
#endif
}

/* Loads eight points of positions (packed x, y, z); out[k] holds their coordinates k. */
static inline void f64x8_load_points(const double *positions, const uint32_t indices[8], f64x8 out[3]) {
    f64x8 points[4], pairs[4];
    for (int i = 0; i < 4; i++) {
        f64x4 a = f64x4_load_point(positions + (size_t)indices[i] * 3);
        f64x4 b = f64x4_load_point(positions + (size_t)indices[4 + i] * 3);
        points[i] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    for (int i = 0; i < 2; i++) { /* x x z z of two points, twice; y y . . */
        pairs[i] = __builtin_shufflevector(points[2 * i], points[2 * i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        pairs[2 + i] = __builtin_shufflevector(points[2 * i], points[2 * i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    out[0] = __builtin_shufflevector(pairs[0], pairs[1], 0, 1, 8, 9, 4, 5, 12, 13);
    out[1] = __builtin_shufflevector(pairs[2], pairs[3], 0, 1, 8, 9, 4, 5, 12, 13);
    out[2] = __builtin_shufflevector(pairs[0], pairs[1], 2, 3, 10, 11, 6, 7, 14, 15);
}

#endif
