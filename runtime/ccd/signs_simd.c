/* Level one of the elementary tests on many pairs at a time: separating axes, signs of the cubic. */
#include "runtime/ccd/ccd_kernels_simd.h"
#include "runtime/ccd/feature_pairs_simd.h"
#include "runtime/ccd/keep.h"

/* Lanes whose features lie beyond each other along an axis, on the same side at both ends. */
static uint32_t separated_by_axes(const points_x8 *p, cscd_contact_kind kind) {
    uint32_t apart = 0;
    for (int k = 0; k < 3; k++) {
        uint32_t before = ALL_WIDTH, beyond = ALL_WIDTH;
        for (int end = 0; end < 2; end++) {
            const f64w(*x)[3] = end == 0 ? p->x0 : p->x1;
            f64w a_low = x[0][k], a_high = x[0][k];
            f64w b_low = f64w_min(x[2][k], x[3][k]), b_high = f64w_max(x[2][k], x[3][k]);
            if (kind == CSCD_CONTACT_EE) {
                a_low = f64w_min(x[0][k], x[1][k]);
                a_high = f64w_max(x[0][k], x[1][k]);
            } else {
                b_low = f64w_min(x[1][k], b_low);
                b_high = f64w_max(x[1][k], b_high);
            }
            before &= f64w_below(a_high, b_low);
            beyond &= f64w_below(b_high, a_low);
        }
        apart |= before | beyond;
    }
    return apart;
}

/* Lanes in which all coefficients lie beyond the error on one side of zero. */
static uint32_t excluded(const cubics_x8 *f) {
    uint32_t above = ALL_WIDTH, below = ALL_WIDTH;
    for (int i = 0; i < 4; i++) {
        above &= f64w_below(f->error, f->b[i]);
        below &= f64w_below(f->b[i], -f->error);
    }
    return above | below;
}

static inline uint32_t open_lanes(const points_x8 *points, cscd_contact_kind kind) {
    vectors_x8 vectors;
    cubics_x8 f;
    uint32_t open = ALL_WIDTH & ~separated_by_axes(points, kind);
    if (open == 0) return 0;
    vectors_between(points, kind, &vectors);
    cubics_of(&vectors, &f);
    return open & ~excluded(&f);
}

/* What fills up the last vector. */
static inline void repeat_last(feature_pairs *pairs) {
    for (uint32_t i = 0; i < WIDTH - 1; i++) {
        pairs->a[pairs->count + i] = pairs->a[pairs->count - 1];
        pairs->b[pairs->count + i] = pairs->b[pairs->count - 1];
    }
}

static inline void keep_open(const feature_source *source, feature_pairs *pairs, cscd_contact_kind kind) {
    uint32_t kept = 0;
    if (pairs->count == 0) return;
    repeat_last(pairs);
    for (uint32_t i = 0; i < pairs->count; i += WIDTH) {
        points_x8 points;
        load_features(source, kind, pairs->a + i, pairs->b + i, &points);
        uint32_t rest = pairs->count - i, real = rest < WIDTH ? (1u << rest) - 1 : ALL_WIDTH;
        uint32_t open = real & open_lanes(&points, kind);
        for (uint32_t lane = 0; lane < WIDTH; lane++)
            kept = keep_pair(pairs, i + lane, open >> lane & 1, kept);
    }
    pairs->count = kept;
}

void SIMD_NAME(reject_by_signs_vf)(const feature_source *source, feature_pairs *pairs) {
    keep_open(source, pairs, CSCD_CONTACT_VF);
}

void SIMD_NAME(reject_by_signs_ee)(const feature_source *source, feature_pairs *pairs) {
    keep_open(source, pairs, CSCD_CONTACT_EE);
}
