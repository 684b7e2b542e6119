/* Vectors of eight numbers: the one place that knows processors, together with simd_wide.h.
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
 *     load_quads, store_quads                                   x      loops over rows of four
 *
 * f64w and i64w are in simd_wide.h; the operations across lanes are at the end.
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
#elif SIMD_LEVEL == SIMD_NEON
#include <arm_neon.h>
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

/* Vectors of eight are two quads of NEON, or four pairs.
 *
 * gcc computes + - * / and & of such vectors in quads on its own. Comparisons, and casts between vectors of floats and of
 * integers, it would do lane by lane or through memory, so they are here. */

/* The quads of a vector. A union costs nothing; a shuffle of a vector of eight would go through memory. */
typedef union f32_quads {
    f32x8 whole;
    float32x4_t quads[2];
} f32_quads;

typedef union i32_quads {
    i32x8 whole;
    uint32x4_t quads[2];
} i32_quads;

typedef union f64_pairs {
    f64x8 whole;
    float64x2_t pairs[4];
} f64_pairs;

/* Four doubles, of which only the first three are loaded. */
typedef union f64_point {
    f64x4 whole;
    float64x2_t pairs[2];
} f64_point;

/* All bits of a lane are equal; returns the set of lanes whose bits are set. */
static inline uint32_t lanes_of_halves(uint16x8_t v) {
    const uint16x8_t bits = {1, 2, 4, 8, 16, 32, 64, 128};
    return vaddvq_u16(vandq_u16(v, bits));
}

static inline uint32_t lanes_of_quads(uint32x4_t low, uint32x4_t high) {
    return lanes_of_halves(vuzp1q_u16(vreinterpretq_u16_u32(low), vreinterpretq_u16_u32(high)));
}

static inline f32x8 f32x8_abs(f32x8 v) {
    f32_quads a = {v};
    for (int i = 0; i < 2; i++) a.quads[i] = vabsq_f32(a.quads[i]);
    return a.whole;
}

static inline f64x8 f64x8_abs(f64x8 v) {
    f64_pairs a = {v};
    for (int i = 0; i < 4; i++) a.pairs[i] = vabsq_f64(a.pairs[i]);
    return a.whole;
}

static inline f32x8 f32x8_sqrt(f32x8 v) {
    f32_quads a = {v};
    for (int i = 0; i < 2; i++) a.quads[i] = vsqrtq_f32(a.quads[i]);
    return a.whole;
}

static inline f64x8 f64x8_sqrt(f64x8 v) {
    f64_pairs a = {v};
    for (int i = 0; i < 4; i++) a.pairs[i] = vsqrtq_f64(a.pairs[i]);
    return a.whole;
}

/* vminq and vmaxq return a NaN where there is one; these return b, as on the other levels. */
static inline f32x8 f32x8_min(f32x8 v, f32x8 w) {
    f32_quads a = {v}, b = {w};
    for (int i = 0; i < 2; i++)
        a.quads[i] = vbslq_f32(vcltq_f32(a.quads[i], b.quads[i]), a.quads[i], b.quads[i]);
    return a.whole;
}

static inline f32x8 f32x8_max(f32x8 v, f32x8 w) {
    f32_quads a = {v}, b = {w};
    for (int i = 0; i < 2; i++)
        a.quads[i] = vbslq_f32(vcgtq_f32(a.quads[i], b.quads[i]), a.quads[i], b.quads[i]);
    return a.whole;
}

static inline f64x8 f64x8_min(f64x8 v, f64x8 w) {
    f64_pairs a = {v}, b = {w};
    for (int i = 0; i < 4; i++)
        a.pairs[i] = vbslq_f64(vcltq_f64(a.pairs[i], b.pairs[i]), a.pairs[i], b.pairs[i]);
    return a.whole;
}

static inline f64x8 f64x8_max(f64x8 v, f64x8 w) {
    f64_pairs a = {v}, b = {w};
    for (int i = 0; i < 4; i++)
        a.pairs[i] = vbslq_f64(vcgtq_f64(a.pairs[i], b.pairs[i]), a.pairs[i], b.pairs[i]);
    return a.whole;
}

static inline uint32_t f32x8_below(f32x8 v, f32x8 w) {
    f32_quads a = {v}, b = {w};
    return lanes_of_quads(vcltq_f32(a.quads[0], b.quads[0]), vcltq_f32(a.quads[1], b.quads[1]));
}

static inline uint32_t f64x8_below(f64x8 v, f64x8 w) {
    f64_pairs a = {v}, b = {w};
    uint32x4_t below[4];
    for (int i = 0; i < 4; i++) below[i] = vreinterpretq_u32_u64(vcltq_f64(a.pairs[i], b.pairs[i]));
    return lanes_of_quads(vuzp1q_u32(below[0], below[1]), vuzp1q_u32(below[2], below[3]));
}

static inline uint32_t i32x8_negative(i32x8 v) {
    i32_quads a = {v};
    return lanes_of_quads(vcltzq_s32(vreinterpretq_s32_u32(a.quads[0])),
                          vcltzq_s32(vreinterpretq_s32_u32(a.quads[1])));
}

static inline i32x8 i32x8_equal(i32x8 v, i32x8 w) {
    i32_quads a = {v}, b = {w};
    for (int i = 0; i < 2; i++) a.quads[i] = vceqq_u32(a.quads[i], b.quads[i]);
    return a.whole;
}

static inline i32x8 f32x8_above(f32x8 v, f32x8 w) {
    f32_quads a = {v}, b = {w};
    i32_quads above;
    for (int i = 0; i < 2; i++) above.quads[i] = vcgtq_f32(a.quads[i], b.quads[i]);
    return above.whole;
}

static inline f64x4 f64x4_load_point(const double *from) {
    f64_point p = {.pairs = {vld1q_f64(from), vcombine_f64(vld1_f64(from + 2), vdup_n_f64(0.0))}};
    return p.whole;
}

static inline void f64x8_load_points(const double *positions, const uint32_t indices[8], f64x8 out[3]) {
    f64_pairs coordinates[3];
    for (int i = 0; i < 4; i++) {
        const double *first = positions + (size_t)indices[2 * i] * 3;
        const double *second = positions + (size_t)indices[2 * i + 1] * 3;
        float64x2_t a = vld1q_f64(first), b = vld1q_f64(second);
        coordinates[0].pairs[i] = vzip1q_f64(a, b);
        coordinates[1].pairs[i] = vzip2q_f64(a, b);
        coordinates[2].pairs[i] = vcombine_f64(vld1_f64(first + 2), vld1_f64(second + 2));
    }
    for (int k = 0; k < 3; k++) out[k] = coordinates[k].whole;
}

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

/* ---- across lanes -------------------------------------------------------------------------------------- */

/* Operations across the lanes of a vector: the least and the greatest lane, and rows that become columns. They compare and
 * move the same lanes in the same order on every level. */

#if SIMD_LEVEL == SIMD_NEON

/* Lane 0 of what the other levels compute; the other lanes have no part in it. */
static inline float f32x8_least(f32x8 v) {
    f32_quads a = {v};
    float32x4_t four = vbslq_f32(vcltq_f32(a.quads[0], a.quads[1]), a.quads[0], a.quads[1]);
    float32x2_t low = vget_low_f32(four), high = vget_high_f32(four);
    float32x2_t two = vbsl_f32(vclt_f32(low, high), low, high);
    float first = vget_lane_f32(two, 0), second = vget_lane_f32(two, 1);
    return first < second ? first : second;
}

static inline float f32x8_greatest(f32x8 v) {
    f32_quads a = {v};
    float32x4_t four = vbslq_f32(vcgtq_f32(a.quads[0], a.quads[1]), a.quads[0], a.quads[1]);
    float32x2_t low = vget_low_f32(four), high = vget_high_f32(four);
    float32x2_t two = vbsl_f32(vcgt_f32(low, high), low, high);
    float first = vget_lane_f32(two, 0), second = vget_lane_f32(two, 1);
    return first > second ? first : second;
}

/* Turns four rows of four into columns. */
static inline void transpose_quads(float32x4_t r[4]) {
    float32x4_t a = vzip1q_f32(r[0], r[2]), b = vzip2q_f32(r[0], r[2]);
    float32x4_t c = vzip1q_f32(r[1], r[3]), d = vzip2q_f32(r[1], r[3]);
    r[0] = vzip1q_f32(a, c);
    r[1] = vzip2q_f32(a, c);
    r[2] = vzip1q_f32(b, d);
    r[3] = vzip2q_f32(b, d);
}

static inline void f32x8_transpose(f32x8 r[8]) {
    float32x4_t corners[2][2][4]; /* rows 0-3 or 4-7, columns 0-3 or 4-7 */
    for (int i = 0; i < 8; i++) {
        f32_quads row = {r[i]};
        for (int half = 0; half < 2; half++) corners[i / 4][half][i % 4] = row.quads[half];
    }
    for (int i = 0; i < 4; i++) transpose_quads(corners[i / 2][i % 2]);
    for (int i = 0; i < 8; i++) {
        f32_quads column = {.quads = {corners[0][i / 4][i % 4], corners[1][i / 4][i % 4]}};
        r[i] = column.whole;
    }
}

#else

static inline float f32x8_least(f32x8 v) {
    v = f32x8_min(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
    v = f32x8_min(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5));
    v = f32x8_min(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6));
    return v[0];
}

static inline float f32x8_greatest(f32x8 v) {
    v = f32x8_max(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
    v = f32x8_max(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5));
    v = f32x8_max(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6));
    return v[0];
}

/* Turns rows into columns. */
static inline void f32x8_transpose(f32x8 r[8]) {
    f32x8 pairs[8], quads[8];
    for (int i = 0; i < 8; i += 2) {
        pairs[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
        pairs[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (int i = 0; i < 8; i += 4) {
        quads[i] = __builtin_shufflevector(pairs[i], pairs[i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
        quads[i + 1] = __builtin_shufflevector(pairs[i], pairs[i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        quads[i + 2] = __builtin_shufflevector(pairs[i + 1], pairs[i + 3], 0, 1, 8, 9, 4, 5, 12, 13);
        quads[i + 3] = __builtin_shufflevector(pairs[i + 1], pairs[i + 3], 2, 3, 10, 11, 6, 7, 14, 15);
    }
    for (int i = 0; i < 4; i++) {
        r[i] = __builtin_shufflevector(quads[i], quads[4 + i], 0, 1, 2, 3, 8, 9, 10, 11);
        r[4 + i] = __builtin_shufflevector(quads[i], quads[4 + i], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

#endif
