/* Vectors of as many doubles as the processor takes at once: see simd.h, which knows processors, too. They serve loops whose
 * lanes do not depend on each other, so that their number changes no result. */
#pragma once

#include "src/core/simd.h"

#if SIMD_LEVEL == SIMD_AVX512
enum { WIDTH = 8 };
#elif SIMD_LEVEL == SIMD_AVX2
enum { WIDTH = 4 };
#else
enum { WIDTH = 2 };
#endif

typedef double f64w __attribute__((vector_size(WIDTH * sizeof(double))));
typedef int64_t i64w __attribute__((vector_size(WIDTH * sizeof(int64_t))));

#if SIMD_LEVEL == SIMD_AVX512

static inline f64w f64w_min(f64w a, f64w b) {
    return _mm512_min_pd(a, b);
}

static inline f64w f64w_max(f64w a, f64w b) {
    return _mm512_max_pd(a, b);
}

static inline uint32_t f64w_below(f64w a, f64w b) {
    return _cvtmask8_u32(_mm512_cmp_pd_mask(a, b, _CMP_LT_OQ));
}

static inline uint32_t f64w_at_most(f64w a, f64w b) {
    return _cvtmask8_u32(_mm512_cmp_pd_mask(a, b, _CMP_LE_OQ));
}

/* Takes a in the lanes whose bit is set, and b in the others. */
static inline f64w f64w_select(uint32_t lanes, f64w a, f64w b) {
    return _mm512_mask_blend_pd(_cvtu32_mask8(lanes), b, a);
}

static inline f64w f64w_abs(f64w v) {
    return _mm512_abs_pd(v);
}

static inline f64w f64w_sqrt(f64w v) {
    return _mm512_sqrt_pd(v);
}

/* Loads WIDTH points of positions (packed x, y, z); out[k] holds their coordinates k. */
static inline void f64w_load_points(const double *positions, const uint32_t indices[WIDTH], f64w out[3]) {
    f64x8_load_points(positions, indices, out);
}

#elif SIMD_LEVEL == SIMD_AVX2

static inline f64w f64w_min(f64w a, f64w b) {
    return _mm256_min_pd(a, b);
}

static inline f64w f64w_max(f64w a, f64w b) {
    return _mm256_max_pd(a, b);
}

static inline uint32_t f64w_below(f64w a, f64w b) {
    return (uint32_t)_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_LT_OQ));
}

static inline uint32_t f64w_at_most(f64w a, f64w b) {
    return (uint32_t)_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_LE_OQ));
}

static inline f64w f64w_select(uint32_t lanes, f64w a, f64w b) {
    __m256i bits = _mm256_setr_epi64x(1, 2, 4, 8), all = _mm256_set1_epi64x(lanes);
    __m256i chosen = _mm256_cmpeq_epi64(_mm256_and_si256(all, bits), bits);
    return _mm256_blendv_pd(b, a, _mm256_castsi256_pd(chosen));
}

static inline f64w f64w_abs(f64w v) {
    return _mm256_andnot_pd(_mm256_set1_pd(-0.0), v);
}

static inline f64w f64w_sqrt(f64w v) {
    return _mm256_sqrt_pd(v);
}

static inline void f64w_load_points(const double *positions, const uint32_t indices[WIDTH], f64w out[3]) {
    f64x4 p[4];
    for (int i = 0; i < 4; i++) p[i] = f64x4_load_point(positions + (size_t)indices[i] * 3);
    f64x4 xz01 = _mm256_unpacklo_pd(p[0], p[1]), y01 = _mm256_unpackhi_pd(p[0], p[1]);
    f64x4 xz23 = _mm256_unpacklo_pd(p[2], p[3]), y23 = _mm256_unpackhi_pd(p[2], p[3]);
    out[0] = _mm256_permute2f128_pd(xz01, xz23, 0x20);
    out[1] = _mm256_permute2f128_pd(y01, y23, 0x20);
    out[2] = _mm256_permute2f128_pd(xz01, xz23, 0x31);
}

#elif SIMD_LEVEL == SIMD_NEON

/* vminq and vmaxq return a NaN where there is one; these return b, as on the other levels. */
static inline f64w f64w_min(f64w a, f64w b) {
    return vbslq_f64(vcltq_f64(a, b), a, b);
}

static inline f64w f64w_max(f64w a, f64w b) {
    return vbslq_f64(vcgtq_f64(a, b), a, b);
}

/* All bits of a lane are equal. */
static inline uint32_t lanes_of_pair(uint64x2_t v) {
    const uint64x2_t bits = {1, 2};
    return (uint32_t)vaddvq_u64(vandq_u64(v, bits));
}

static inline uint32_t f64w_below(f64w a, f64w b) {
    return lanes_of_pair(vcltq_f64(a, b));
}

static inline uint32_t f64w_at_most(f64w a, f64w b) {
    return lanes_of_pair(vcleq_f64(a, b));
}

static inline f64w f64w_select(uint32_t lanes, f64w a, f64w b) {
    const uint64x2_t bits = {1, 2};
    return vbslq_f64(vtstq_u64(vdupq_n_u64(lanes), bits), a, b);
}

static inline f64w f64w_abs(f64w v) {
    return vabsq_f64(v);
}

static inline f64w f64w_sqrt(f64w v) {
    return vsqrtq_f64(v);
}

static inline void f64w_load_points(const double *positions, const uint32_t indices[WIDTH], f64w out[3]) {
    const double *first = positions + (size_t)indices[0] * 3, *second = positions + (size_t)indices[1] * 3;
    float64x2_t a = vld1q_f64(first), b = vld1q_f64(second);
    out[0] = vzip1q_f64(a, b);
    out[1] = vzip2q_f64(a, b);
    out[2] = vcombine_f64(vld1_f64(first + 2), vld1_f64(second + 2));
}

#else

static inline f64w f64w_min(f64w a, f64w b) {
    i64w below = a < b;
    return (f64w)(((i64w)a & below) | ((i64w)b & ~below));
}

static inline f64w f64w_max(f64w a, f64w b) {
    i64w above = a > b;
    return (f64w)(((i64w)a & above) | ((i64w)b & ~above));
}

static inline uint32_t f64w_below(f64w a, f64w b) {
    return (uint32_t)(a[0] < b[0]) | (uint32_t)(a[1] < b[1]) << 1;
}

static inline uint32_t f64w_at_most(f64w a, f64w b) {
    return (uint32_t)(a[0] <= b[0]) | (uint32_t)(a[1] <= b[1]) << 1;
}

static inline f64w f64w_select(uint32_t lanes, f64w a, f64w b) {
    i64w chosen = {-(int64_t)(lanes & 1), -(int64_t)(lanes >> 1 & 1)};
    return (f64w)(((i64w)a & chosen) | ((i64w)b & ~chosen));
}

static inline f64w f64w_abs(f64w v) {
    return (f64w)((i64w)v & INT64_MAX);
}

static inline f64w f64w_sqrt(f64w v) {
    return (f64w){sqrt(v[0]), sqrt(v[1])};
}

static inline void f64w_load_points(const double *positions, const uint32_t indices[WIDTH], f64w out[3]) {
    const double *a = positions + (size_t)indices[0] * 3, *b = positions + (size_t)indices[1] * 3;
    for (int k = 0; k < 3; k++) out[k] = (f64w){a[k], b[k]};
}

#endif

/* A choice between lanes that stays in the registers where the comparison leaves it; & joins two of them. */
#if SIMD_LEVEL == SIMD_AVX512
typedef uint32_t maskw;
#else
typedef i64w maskw;
#endif

static inline maskw maskw_below(f64w a, f64w b) {
#if SIMD_LEVEL == SIMD_AVX512
    return f64w_below(a, b);
#else
    return a < b;
#endif
}

static inline maskw maskw_at_most(f64w a, f64w b) {
#if SIMD_LEVEL == SIMD_AVX512
    return f64w_at_most(a, b);
#else
    return a <= b;
#endif
}

/* Takes a in the lanes of the mask, and b in the others. */
static inline f64w maskw_choose(maskw mask, f64w a, f64w b) {
#if SIMD_LEVEL == SIMD_AVX512
    return f64w_select(mask, a, b);
#elif SIMD_LEVEL == SIMD_AVX2
    return _mm256_blendv_pd(b, a, (f64w)mask);
#else
    return (f64w)(((i64w)a & mask) | ((i64w)b & ~mask));
#endif
}

enum { ALL_WIDTH = (1 << WIDTH) - 1 };

static inline f64w f64w_all(double x) {
    f64w zero = {0.0};
    return x - zero;
}

/* ---- rows of four doubles -------------------------------------------------------------------------------- */

/* Lane i of out[k] is the k-th of four doubles at rows[i]; and back. */
#if SIMD_LEVEL == SIMD_AVX512

/* Of each half. */
static inline void f64w_transpose(f64w r[4]) {
    f64w pairs[4];
    for (int i = 0; i < 2; i++) {
        pairs[i] = __builtin_shufflevector(r[2 * i], r[2 * i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        pairs[2 + i] = __builtin_shufflevector(r[2 * i], r[2 * i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (int i = 0; i < 2; i++) {
        r[i] = __builtin_shufflevector(pairs[2 * i], pairs[2 * i + 1], 0, 1, 8, 9, 4, 5, 12, 13);
        r[2 + i] = __builtin_shufflevector(pairs[2 * i], pairs[2 * i + 1], 2, 3, 10, 11, 6, 7, 14, 15);
    }
}

static inline void f64w_load_quads(const double *const rows[WIDTH], f64w out[4]) {
    for (int i = 0; i < 4; i++) {
        f64x4 low, high;
        memcpy(&low, rows[i], sizeof low);
        memcpy(&high, rows[4 + i], sizeof high);
        out[i] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    f64w_transpose(out);
}

static inline void f64w_store_quads(const f64w v[4], double *const rows[WIDTH]) {
    f64w q[4];
    memcpy(q, v, sizeof q);
    f64w_transpose(q);
    for (int i = 0; i < 4; i++) {
        f64x4 low = __builtin_shufflevector(q[i], q[i], 0, 1, 2, 3);
        f64x4 high = __builtin_shufflevector(q[i], q[i], 4, 5, 6, 7);
        memcpy(rows[i], &low, sizeof low);
        memcpy(rows[4 + i], &high, sizeof high);
    }
}

#elif SIMD_LEVEL == SIMD_AVX2

static inline void f64w_transpose(f64w r[4]) {
    f64w a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6),
         b = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
    f64w c = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7),
         d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    r[0] = __builtin_shufflevector(a, b, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(c, d, 0, 1, 4, 5);
    r[2] = __builtin_shufflevector(a, b, 2, 3, 6, 7);
    r[3] = __builtin_shufflevector(c, d, 2, 3, 6, 7);
}

static inline void f64w_load_quads(const double *const rows[WIDTH], f64w out[4]) {
    for (int i = 0; i < 4; i++) memcpy(&out[i], rows[i], sizeof out[i]);
    f64w_transpose(out);
}

static inline void f64w_store_quads(const f64w v[4], double *const rows[WIDTH]) {
    f64w r[4] = {v[0], v[1], v[2], v[3]};
    f64w_transpose(r);
    for (int i = 0; i < 4; i++) memcpy(rows[i], &r[i], sizeof r[i]);
}

#else

static inline void f64w_load_quads(const double *const rows[WIDTH], f64w out[4]) {
    for (int k = 0; k < 4; k++) out[k] = (f64w){rows[0][k], rows[1][k]};
}

static inline void f64w_store_quads(const f64w v[4], double *const rows[WIDTH]) {
    for (int k = 0; k < 4; k++) {
        rows[0][k] = v[k][0];
        rows[1][k] = v[k][1];
    }
}

#endif
