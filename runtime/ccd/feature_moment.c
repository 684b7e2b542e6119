/* Two moving features in their own frame, and their nearest points at one moment. */
#include "runtime/ccd/feature_moment.h"

#include "runtime/ccd/closest.h"
#include "src/core/vec3.h"

#include <string.h>

/* ---- the query ------------------------------------------------------------------------------------- */

/* The origin of the frame at either end. */
static const double *origin_at_end(const elementary_query *query, query_frame frame) {
    return frame == FRAME_MOVING ? query->x1[0] : query->x0[0];
}

static double query_extent(const elementary_query *query, const double origin1[3]) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            largest = max_of(largest, fabs(query->x0[i][k] - query->x0[0][k]));
            largest = max_of(largest, fabs(query->x1[i][k] - origin1[k]));
        }
    }
    return largest;
}

local_query local_query_of(const elementary_query *query, cscd_contact_kind kind, query_frame frame) {
    local_query local = {.kind = kind, .frame = frame};
    const double *origin1 = origin_at_end(query, frame);
    int exponent = 0;
    frexp(query_extent(query, origin1), &exponent);
    local.scale = ldexp(1.0, -exponent);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            local.at.x0[i][k] = (query->x0[i][k] - query->x0[0][k]) * local.scale;
            local.at.x1[i][k] = (query->x1[i][k] - origin1[k]) * local.scale;
        }
    }
    const elementary_query *at = frame == FRAME_MOVING ? &local.at : query;
    local.still = memcmp(at->x0, at->x1, sizeof at->x0) == 0;
    return local;
}

double local_query_extent_at_start(const local_query *local) {
    double largest = 0.0;
    for (int i = 1; i < 4; i++) largest = max_of(largest, vec3_largest(local->at.x0[i]));
    return largest;
}

/* ---- the features at a moment ---------------------------------------------------------------------- */

static void connect_vf(feature_moment *m) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    const double(*velocity)[3] = (const double(*)[3])m->features.velocity;
    closest_point_triangle(x[0], x[1], x[2], x[3], &m->u, &m->v);
    double u = m->u, v = m->v;
    for (int k = 0; k < 3; k++) {
        m->shortest.offset[k] = (x[0][k] - x[1][k]) - u * (x[2][k] - x[1][k]) - v * (x[3][k] - x[1][k]);
        m->shortest.change[k] = (velocity[0][k] - velocity[1][k]) - u * (velocity[2][k] - velocity[1][k]) -
                                v * (velocity[3][k] - velocity[1][k]);
        m->middle[k] = x[0][k] - 0.5 * m->shortest.offset[k];
    }
    bool on_last = u + v >= 1.0;
    m->shortest.inside[0] = u > 0.0 && u < 1.0 && !(on_last && v > 0.0);
    m->shortest.inside[1] = v > 0.0 && v < 1.0 && !(on_last && u > 0.0);
    m->shortest.inside[2] = u > 0.0 && v > 0.0 && on_last;
}

static void connect_ee(feature_moment *m) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    const double(*velocity)[3] = (const double(*)[3])m->features.velocity;
    closest_segments(x[0], x[1], x[2], x[3], &m->u, &m->v);
    double u = m->u, v = m->v;
    for (int k = 0; k < 3; k++) {
        m->shortest.offset[k] = (x[0][k] - x[2][k]) + u * (x[1][k] - x[0][k]) - v * (x[3][k] - x[2][k]);
        m->shortest.change[k] = (velocity[0][k] - velocity[2][k]) + u * (velocity[1][k] - velocity[0][k]) -
                                v * (velocity[3][k] - velocity[2][k]);
        m->middle[k] = x[0][k] + u * (x[1][k] - x[0][k]) - 0.5 * m->shortest.offset[k];
    }
    m->shortest.inside[0] = u > 0.0 && u < 1.0;
    m->shortest.inside[1] = v > 0.0 && v < 1.0;
}

/* ---- the offset with twice the digits ---------------------------------------------------------------- */

/* A sum of two doubles (Dekker 1971). */
typedef struct long_sum {
    double high, low;
} long_sum;

static long_sum sum_of(double a, double b) {
    double sum = a + b, part = sum - a;
    return (long_sum){sum, (a - (sum - part)) + (b - part)};
}

static void split_digits(double x, double *high, double *low) {
    double scaled = 134217729.0 * x; /* 2^27 + 1 */
    *high = scaled - (scaled - x);
    *low = x - *high;
}

static long_sum product_of(double a, double b) {
    double a_high, a_low, b_high, b_low, product = a * b;
    split_digits(a, &a_high, &a_low);
    split_digits(b, &b_high, &b_low);
    double rest = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return (long_sum){product, rest};
}

static long_sum add_long(long_sum a, long_sum b) {
    long_sum sum = sum_of(a.high, b.high);
    return sum_of(sum.high, sum.low + (a.low + b.low));
}

/* share * (to - from) */
static long_sum share_of_side(double share, double from, double to) {
    long_sum side = sum_of(to, -from), product = product_of(share, side.high);
    product.low += share * side.low;
    return product;
}

/* The same offset as of connect_vf or connect_ee. It is off by 2^-53 of its length and 2^-100 of the extent, so that the
 * planes across it are as good as their own rounding. */
static void refine_offset(feature_moment *m) {
    const double(*x)[3] = (const double(*)[3])m->features.x;
    bool vf = m->features.kind == CSCD_CONTACT_VF;
    for (int k = 0; k < 3; k++) {
        long_sum offset = sum_of(x[0][k], -x[vf ? 1 : 2][k]);
        offset = add_long(offset, vf ? share_of_side(-m->u, x[1][k], x[2][k])
                                     : share_of_side(m->u, x[0][k], x[1][k]));
        offset = add_long(offset, share_of_side(-m->v, x[vf ? 1 : 2][k], x[3][k]));
        m->shortest.offset[k] = offset.high;
    }
}

void feature_moment_move(const local_query *local, double t, feature_moment *m) {
    m->t = t;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++)
            m->features.x[i][k] = (1.0 - t) * local->at.x0[i][k] + t * local->at.x1[i][k];
    }
    if (local->kind == CSCD_CONTACT_VF)
        connect_vf(m);
    else
        connect_ee(m);
    if (local->frame == FRAME_MOVING) refine_offset(m);
    m->distance = sqrt(vec3_dot(m->shortest.offset, m->shortest.offset));
}

feature_moment feature_moment_start(const local_query *local) {
    feature_moment m = {.features.kind = local->kind};
    for (int i = 0; i < 4; i++) vec3_subtract(local->at.x1[i], local->at.x0[i], m.features.velocity[i]);
    feature_moment_move(local, 0.0, &m);
    return m;
}
