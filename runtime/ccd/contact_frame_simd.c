/* Describes many contacts at a time. The twin of contact_frame.c: the same operations in the same order, so the same bits. */
#include "runtime/ccd/ccd_kernels_simd.h"
#include "runtime/ccd/closest_simd.h"
#include "runtime/ccd/cubic_simd.h"

/* Vectors between the points at one moment. */
typedef struct moment_x8 {
    f64w a[3], b[3], c[3];
} moment_x8;

static inline f64w largest_of(const f64w v[3]) {
    return f64w_max(f64w_abs(v[0]), f64w_max(f64w_abs(v[1]), f64w_abs(v[2])));
}

static inline f64w largest_coordinate_x8(const points_x8 *points) {
    f64w largest = f64w_all(0.0);
    for (int i = 0; i < 4; i++)
        largest = f64w_max(largest, f64w_max(largest_of(points->x0[i]), largest_of(points->x1[i])));
    return largest;
}

static inline moment_x8 vectors_at_x8(const vectors_x8 *v, f64w t) {
    moment_x8 m;
    for (int k = 0; k < 3; k++) {
        m.a[k] = blend_linearly(v->a[0][k], v->a[1][k], t);
        m.b[k] = blend_linearly(v->b[0][k], v->b[1][k], t);
        m.c[k] = blend_linearly(v->c[0][k], v->c[1][k], t);
    }
    return m;
}

/* ---- scaling by powers of two ------------------------------------------------------------------------------ */

/* As exponent_of and power_of_two in floating.h. */
static inline i64w exponents_of(f64w x) {
    i64w biased = (i64w)x >> 52 & 0x7ff;
    return (biased - 1022) & (biased != 0);
}

static inline f64w powers_of_two(i64w exponents) {
    return (f64w)((exponents + 1023) << 52);
}

static inline i64w scale_to_one_x8(const f64w v[3], f64w out[3]) {
    i64w exponents = exponents_of(largest_of(v));
    f64w factor = powers_of_two(-exponents);
    for (int k = 0; k < 3; k++) out[k] = factor * v[k];
    return exponents;
}

static inline i64w scaled_cross_x8(const moment_x8 *m, f64w out[3]) {
    f64w a[3], b[3];
    i64w exponents = scale_to_one_x8(m->a, a);
    exponents += scale_to_one_x8(m->b, b);
    cross_x8(a, b, out);
    return exponents;
}

/* ---- the parts of a description ------------------------------------------------------------------------------ */

/* Earlier times, at which a gap is left, unless the slope is lost in rounding. */
static inline f64w leave_gaps(const vectors_x8 *vectors, f64w coordinate, const cubics_x8 *f, f64w toi) {
    const f64w gap_left = f64w_all(0x1p-48), earlier_at_most = f64w_all(0x1p-32);
    f64w cross[3];
    polar_x8 p = polar_at(f->b, toi);
    f64w slope = f64w_abs(3.0 * (p.high - p.low));
    moment_x8 m = vectors_at_x8(vectors, toi);
    i64w exponents = scaled_cross_x8(&m, cross);
    f64w speed = slope * powers_of_two(-exponents) / f64w_sqrt(dot_x8(cross, cross));
    f64w earlier = f64w_max(toi - f64w_min(gap_left * coordinate / speed, earlier_at_most), f64w_all(0.0));
    return f64w_select(f64w_below(8.0 * f->error, slope), earlier, toi);
}

static inline void select_points(uint32_t lanes, const f64w a[3], const f64w b[3], f64w out[3]) {
    for (int k = 0; k < 3; k++) out[k] = f64w_select(lanes, a[k], b[k]);
}

/* The segments are relative to the start of the shorter one, so that its shape survives the addition. */
static inline parameters_x8 parameters_on_edges(const f64w a[3], const f64w b[3], const f64w c[3]) {
    const f64w zero = f64w_all(0.0), origin[3] = {zero, zero, zero};
    f64w back[3], end_a[3], end_b[3];
    segments_x8 s;
    uint32_t first = f64w_below(largest_of(a), largest_of(b));
    for (int k = 0; k < 3; k++) {
        back[k] = -c[k];
        end_a[k] = back[k] + a[k];
        end_b[k] = c[k] + b[k];
    }
    select_points(first, origin, back, s.a0);
    select_points(first, a, end_a, s.a1);
    select_points(first, c, origin, s.b0);
    select_points(first, end_b, b, s.b1);
    return closest_segments_x8(&s);
}

static inline parameters_x8 find_parameters_x8(const moment_x8 *m, cscd_contact_kind kind) {
    f64w a[3], b[3], c[3];
    f64w largest = f64w_max(largest_of(m->a), f64w_max(largest_of(m->b), largest_of(m->c)));
    f64w factor = powers_of_two(-exponents_of(largest));
    for (int k = 0; k < 3; k++) {
        a[k] = factor * m->a[k];
        b[k] = factor * m->b[k];
        c[k] = factor * m->c[k];
    }
    return kind == CSCD_CONTACT_VF ? closest_point_triangle_x8(c, a, b) : parameters_on_edges(a, b, c);
}

static inline void connect_points_x8(const f64w a[3], const f64w b[3], const f64w c[3],
                                     cscd_contact_kind kind, parameters_x8 at, f64w out[3]) {
    double sign = kind == CSCD_CONTACT_VF ? 1.0 : -1.0;
    for (int k = 0; k < 3; k++) out[k] = sign * (c[k] - at.u * a[k]) - at.v * b[k];
}

static inline void contact_normals(const vectors_x8 *v, const moment_x8 *m, cscd_contact_kind kind,
                                   parameters_x8 at, f64w normal[3]) {
    const f64w zero = f64w_all(0.0), one = f64w_all(1.0);
    f64w cross[3], start[3], end[3], motion[3];
    scaled_cross_x8(m, cross);
    scale_to_one_x8(cross, normal);
    f64w length = f64w_sqrt(dot_x8(normal, normal));
    connect_points_x8(v->a[0], v->b[0], v->c[0], kind, at, start);
    connect_points_x8(v->a[1], v->b[1], v->c[1], kind, at, end);
    subtract_x8(end, start, motion);
    f64w sign = f64w_select(f64w_below(zero, dot_x8(normal, motion)), -one, one);
    uint32_t known = f64w_below(zero, length);
    for (int k = 0; k < 3; k++) normal[k] = f64w_select(known, sign * normal[k] / length, zero);
}

/* ---- kernels ----------------------------------------------------------------------------------------------------- */

static inline void store_lanes(double *to, f64w v) {
    memcpy(to, &v, sizeof v);
}

static inline void describe_some(const points_x8 *points, cscd_contact_kind kind, f64w begin, int i,
                                 described_contacts *out) {
    vectors_x8 vectors;
    cubics_x8 f;
    f64w apart[3], normal[3];
    vectors_between(points, kind, &vectors);
    cubics_of(&vectors, &f);
    f64w toi = leave_gaps(&vectors, largest_coordinate_x8(points), &f, begin);
    moment_x8 m = vectors_at_x8(&vectors, toi);
    parameters_x8 at = find_parameters_x8(&m, kind);
    connect_points_x8(m.a, m.b, m.c, kind, at, apart);
    contact_normals(&vectors, &m, kind, at, normal);
    store_lanes(out->toi + i, toi);
    store_lanes(out->u + i, at.u);
    store_lanes(out->v + i, at.v);
    for (int k = 0; k < 3; k++) {
        f64w on_a = blend_linearly(points->x0[0][k], points->x1[0][k], toi);
        if (kind == CSCD_CONTACT_EE) on_a += at.u * m.a[k];
        store_lanes(out->point[k] + i, on_a - 0.5 * apart[k]);
        store_lanes(out->normal[k] + i, normal[k]);
    }
}

static inline void describe_eight(const feature_source *source, const found_pairs *pairs,
                                  cscd_contact_kind kind, described_contacts *out) {
    for (int i = 0; i < LANES; i += WIDTH) {
        points_x8 points;
        f64w begin;
        load_features(source, kind, pairs->a + i, pairs->b + i, &points);
        memcpy(&begin, pairs->begin + i, sizeof begin);
        describe_some(&points, kind, begin, i, out);
    }
}

void SIMD_NAME(describe_vf)(const feature_source *source, const found_pairs *pairs, described_contacts *out) {
    describe_eight(source, pairs, CSCD_CONTACT_VF, out);
}

void SIMD_NAME(describe_ee)(const feature_source *source, const found_pairs *pairs, described_contacts *out) {
    describe_eight(source, pairs, CSCD_CONTACT_EE, out);
}
