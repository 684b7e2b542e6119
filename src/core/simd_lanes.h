/* Operations across the lanes of a vector: the least and the greatest lane, and rows that become columns. They compare and
 * move the same lanes in the same order on every level. */
#pragma once

#include "src/core/simd.h"

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
