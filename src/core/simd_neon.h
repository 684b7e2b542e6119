/* Vectors of eight as two quads of NEON, or as four pairs: simd.h includes this on the level NEON and explains the operations.
 *
 * gcc computes + - * / and & of such vectors in quads on its own. Comparisons, and casts between vectors of floats and of
 * integers, it would do lane by lane or through memory, so they are here. */
#pragma once

#include <arm_neon.h>

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
