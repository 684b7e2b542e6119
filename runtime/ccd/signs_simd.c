/* Level one of the elementary tests on many pairs at a time: rejects those that separating axes, or the signs of the
 * cubic, prove to be apart. */
#include "runtime/ccd/ccd_kernels_simd.h"
#include "runtime/ccd/coplanarity_simd.h"
#include "runtime/ccd/separating_axis_simd.h"

/* Lanes in which all coefficients lie beyond the error on one side of zero. */
static uint32_t excluded_by_signs(const cubics_x8 *f) {
    uint32_t above = ALL_WIDTH, below = ALL_WIDTH;
    for (int i = 0; i < 4; i++) {
        above &= f64w_below(f->error, f->b[i]);
        below &= f64w_below(f->b[i], -f->error);
    }
    return above | below;
}

static inline uint32_t undecided_lanes(const points_x8 *points, cscd_contact_kind kind) {
    vectors_x8 vectors;
    cubics_x8 f;
    uint32_t undecided = ALL_WIDTH & ~separated_by_axes_x8(points, kind);
    if (undecided == 0) return 0;
    vectors_between(points, kind, &vectors);
    cubics_of(&vectors, &f);
    return undecided & ~excluded_by_signs(&f);
}

/* Pair i moves to place kept, and stays there if kept_now is 1. Branch-free: the outcome is unpredictable. */
static inline uint32_t keep_pair(feature_pairs *pairs, uint32_t i, uint32_t kept_now, uint32_t kept) {
    pairs->a[kept] = pairs->a[i];
    pairs->b[kept] = pairs->b[i];
    return kept + kept_now;
}

/* Fills up the last vector with the last pair. */
static inline void repeat_last(feature_pairs *pairs) {
    for (uint32_t i = 0; i < WIDTH - 1; i++) {
        pairs->a[pairs->count + i] = pairs->a[pairs->count - 1];
        pairs->b[pairs->count + i] = pairs->b[pairs->count - 1];
    }
}

static inline void reject_by_signs(const feature_source *source, feature_pairs *pairs,
                                   cscd_contact_kind kind) {
    uint32_t kept = 0;
    if (pairs->count == 0) return;
    repeat_last(pairs);
    for (uint32_t i = 0; i < pairs->count; i += WIDTH) {
        points_x8 points;
        load_features(source, kind, pairs->a + i, pairs->b + i, &points);
        uint32_t rest = pairs->count - i, real = rest < WIDTH ? (1u << rest) - 1 : ALL_WIDTH;
        uint32_t undecided = real & undecided_lanes(&points, kind);
        for (uint32_t lane = 0; lane < WIDTH; lane++)
            kept = keep_pair(pairs, i + lane, undecided >> lane & 1, kept);
    }
    pairs->count = kept;
}

void SIMD_NAME(reject_by_signs_vf)(const feature_source *source, feature_pairs *pairs) {
    reject_by_signs(source, pairs, CSCD_CONTACT_VF);
}

void SIMD_NAME(reject_by_signs_ee)(const feature_source *source, feature_pairs *pairs) {
    reject_by_signs(source, pairs, CSCD_CONTACT_EE);
}
