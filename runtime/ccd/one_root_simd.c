/* Level two of the elementary tests on many pairs at a time, where the cubic certainly has one root: the
 * same intervals and verdicts as cubic.c and inside_test.c have. */
#include "runtime/ccd/ccd_kernels_simd.h"
#include "runtime/ccd/inside_test_simd.h"

/* Lanes in which the coefficients certainly change sign once: from positive to negative, and back. */
static inline void single_changes(const cubics_x8 *f, uint32_t *falling, uint32_t *rising) {
    uint32_t above[4], below[4];
    for (int i = 0; i < 4; i++) {
        above[i] = f64w_below(f->error, f->b[i]);
        below[i] = f64w_below(f->b[i], -f->error);
    }
    *falling = above[0] & below[3] & (above[1] | below[2]);
    *rising = below[0] & above[3] & (below[1] | above[2]);
}

/* Lanes in which exactly one root is certainly in the interval, and none outside of it. */
static inline uint32_t isolate_single(const cubics_x8 *f, intervals_x8 *out) {
    uint32_t falling, rising;
    single_changes(f, &falling, &rising);
    f64w root = f->b[0] / (f->b[0] - f->b[3]);
    f64w change = f64w_select(falling, f64w_all(1.0), f64w_all(-1.0));
    return isolate_between(f->b, f->error, falling | rising, f64w_all(0.0), f64w_all(1.0), change, root, out);
}

static inline void decide_by_root(const points_x8 *points, cscd_contact_kind kind, int i,
                                  root_outcomes *out) {
    vectors_x8 vectors;
    cubics_x8 f;
    intervals_x8 interval;
    vectors_between(points, kind, &vectors);
    cubics_of(&vectors, &f);
    uint32_t isolated = isolate_single(&f, &interval);
    sign_lanes touching = inside_test_x8(&vectors, kind, &interval);
    out->apart |= (isolated & touching.wrong) << i;
    out->contacts |= (isolated & touching.right & narrow_enough(&interval)) << i;
    memcpy(out->begin + i, &interval.begin, sizeof interval.begin);
}

void SIMD_NAME(roots_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                         root_outcomes *out) {
    decide_eight(source, a, b, CSCD_CONTACT_VF, decide_by_root, out);
}

void SIMD_NAME(roots_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                         root_outcomes *out) {
    decide_eight(source, a, b, CSCD_CONTACT_EE, decide_by_root, out);
}
