/* Describes many contacts at a time. The twin of contact_frame.c: the same operations in the same order, so
 * the same bits. */
#include "runtime/ccd/ccd_simd.h"
#include "runtime/ccd/cubic_simd.h"

/* ---- closest points of features at rest: the twin of closest.c ----------------------------------------- */

/* The same operations in the same order, so the same bits. If closest.c returns early, lanes go on and their
 * results are not taken. */

enum { PROJECTIONS_MAX = 16 };

typedef struct parameters_x8 {
    f64w u, v;
} parameters_x8;

static inline f64w clamp_to_unit_x8(f64w x) {
    const f64w zero = f64w_all(0.0), one = f64w_all(1.0);
    return f64w_select(f64w_below(x, zero), zero, f64w_select(f64w_below(one, x), one, x));
}

static inline void subtract_x8(const f64w a[3], const f64w b[3], f64w out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

static inline void add_scaled_x8(const f64w a[3], f64w s, const f64w b[3], f64w out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] + s * b[k];
}

static inline f64w nearest_on_segment_x8(const f64w p[3], const f64w a[3], const f64w b[3]) {
    f64w direction[3], offset[3];
    subtract_x8(b, a, direction);
    subtract_x8(p, a, offset);
    f64w length = dot_x8(direction, direction), zero = f64w_all(0.0);
    f64w at = clamp_to_unit_x8(dot_x8(offset, direction) / length);
    return f64w_select(f64w_below(zero, length), at, zero);
}

/* Takes the candidate in the lanes in which it is nearer than the best one so far. */
static inline void keep_nearer(f64w distance, parameters_x8 candidate, f64w *best, parameters_x8 *out) {
    uint32_t nearer = f64w_below(distance, *best);
    *best = f64w_select(nearer, distance, *best);
    out->u = f64w_select(nearer, candidate.u, out->u);
    out->v = f64w_select(nearer, candidate.v, out->v);
}

/* Takes the inner points unless the ones on sides or ends, whose distance is `best`, are nearer. When
 * rounding hides the difference, the inner points are the better ones; below this share of the squared
 * lengths the distance is rounding. */
static inline parameters_x8 inner_or_outer(f64w distance, f64w size, parameters_x8 inner, f64w best,
                                           parameters_x8 outer) {
    const f64w touching = f64w_all(0x1p-90);
    uint32_t found = f64w_below(distance, f64w_all((double)INFINITY));
    uint32_t taken = found & (f64w_at_most(distance, touching * size) | ~f64w_below(best, distance));
    return (parameters_x8){f64w_select(taken, inner.u, outer.u), f64w_select(taken, inner.v, outer.v)};
}

/* ---- a point and the triangle of the origin, a and b --------------------------------------------------------- */

static inline f64w triangle_distance_x8(const f64w p[3], const f64w a[3], const f64w b[3], parameters_x8 at) {
    f64w offset[3];
    for (int k = 0; k < 3; k++) offset[k] = p[k] - at.u * a[k] - at.v * b[k];
    return dot_x8(offset, offset);
}

static inline f64w closest_on_sides_x8(const f64w p[3], const f64w a[3], const f64w b[3],
                                       parameters_x8 *out) {
    const f64w zero = f64w_all(0.0), one = f64w_all(1.0), origin[3] = {zero, zero, zero};
    f64w on_a = nearest_on_segment_x8(p, origin, a), on_ab = nearest_on_segment_x8(p, a, b),
         on_b = nearest_on_segment_x8(p, b, origin), best = f64w_all((double)INFINITY);
    const parameters_x8 candidates[3] = {{on_a, zero}, {one - on_ab, on_ab}, {zero, one - on_b}};
    *out = (parameters_x8){zero, zero};
    for (int i = 0; i < 3; i++)
        keep_nearer(triangle_distance_x8(p, a, b, candidates[i]), candidates[i], &best, out);
    return best;
}

/* Adds the projection of the residual in the given lanes, and returns those of them that it changes. */
static inline uint32_t add_projection_x8(const f64w p[3], const f64w a[3], const f64w b[3],
                                         const f64w normal[3], f64w area, uint32_t lanes, parameters_x8 *at) {
    f64w residual[3], side[3];
    for (int k = 0; k < 3; k++) residual[k] = p[k] - at->u * a[k] - at->v * b[k];
    cross_x8(residual, b, side);
    f64w u = f64w_select(lanes, at->u + dot_x8(side, normal) / area, at->u);
    cross_x8(a, residual, side);
    f64w v = f64w_select(lanes, at->v + dot_x8(side, normal) / area, at->v);
    uint32_t same =
        f64w_at_most(u, at->u) & f64w_at_most(at->u, u) & f64w_at_most(v, at->v) & f64w_at_most(at->v, v);
    *at = (parameters_x8){u, v};
    return lanes & ~same;
}

/* Lanes that no further projection leads into the triangle; closest.c derives the bound. */
static inline uint32_t stays_outside_x8(const f64w p[3], const f64w a[3], const f64w b[3], f64w area,
                                        parameters_x8 at) {
    f64w offset = f64w_all(0.0), long_a = offset, long_b = offset, one = f64w_all(1.0);
    for (int k = 0; k < 3; k++) {
        offset += f64w_abs(p[k]);
        long_a += f64w_abs(a[k]);
        long_b += f64w_abs(b[k]);
    }
    f64w sum = offset + (f64w_abs(at.u) + one) * long_a + (f64w_abs(at.v) + one) * long_b;
    f64w twice = 0x1p-43 * sum * (long_a * long_b);
    f64w off_u = twice * long_b, off_v = twice * long_a;
    uint32_t certain =
        f64w_below(f64w_all(0x1p-900), area) & f64w_at_most(off_u, area) & f64w_at_most(off_v, area);
    f64w beyond = off_u + off_v + 0x1p-43 * (one + f64w_abs(at.u) + f64w_abs(at.v)) * area;
    return certain & (f64w_below(at.u * area, -off_u) | f64w_below(at.v * area, -off_v) |
                      f64w_below(beyond, (at.u + at.v - one) * area));
}

/* Returns infinity in the lanes in which the nearest point of the plane is not in the triangle. */
static inline f64w closest_in_plane_x8(const f64w p[3], const f64w a[3], const f64w b[3], parameters_x8 *at,
                                       f64w *size) {
    const f64w zero = f64w_all(0.0), one = f64w_all(1.0);
    f64w normal[3];
    cross_x8(a, b, normal);
    f64w area = dot_x8(normal, normal);
    *size = dot_x8(a, a) + dot_x8(b, b);
    *at = (parameters_x8){zero, zero};
    uint32_t inside = f64w_below(zero, area), open = inside;
    for (int i = 0; i < PROJECTIONS_MAX && open != 0; i++) {
        open = add_projection_x8(p, a, b, normal, area, open, at);
        if (i == 0) inside &= ~(open & stays_outside_x8(p, a, b, area, *at));
        open &= inside;
    }
    inside &= f64w_at_most(zero, at->u) & f64w_at_most(zero, at->v) & f64w_at_most(at->u + at->v, one);
    return f64w_select(inside, triangle_distance_x8(p, a, b, *at), f64w_all((double)INFINITY));
}

static inline parameters_x8 closest_point_triangle_x8(const f64w p[3], const f64w a[3], const f64w b[3]) {
    f64w size;
    parameters_x8 inner, outer;
    f64w distance = closest_in_plane_x8(p, a, b, &inner, &size);
    f64w best = closest_on_sides_x8(p, a, b, &outer);
    return inner_or_outer(distance, size, inner, best, outer);
}

/* ---- two segments ------------------------------------------------------------------------------------------------ */

typedef struct segments_x8 {
    f64w a0[3], a1[3], b0[3], b1[3];
} segments_x8;

static inline f64w segment_distance_x8(const segments_x8 *s, parameters_x8 at) {
    f64w offset[3];
    for (int k = 0; k < 3; k++)
        offset[k] = (s->a0[k] - s->b0[k]) + at.u * (s->a1[k] - s->a0[k]) - at.v * (s->b1[k] - s->b0[k]);
    return dot_x8(offset, offset);
}

/* Returns infinity in the lanes whose lines are parallel. */
static inline f64w closest_on_lines_x8(const segments_x8 *s, parameters_x8 *at, f64w *size) {
    f64w along_a[3], along_b[3], offset[3], normal[3], side[3], point[3];
    subtract_x8(s->a1, s->a0, along_a);
    subtract_x8(s->b1, s->b0, along_b);
    subtract_x8(s->b0, s->a0, offset);
    cross_x8(along_a, along_b, normal);
    f64w area = dot_x8(normal, normal);
    *size = dot_x8(along_a, along_a) + dot_x8(along_b, along_b);
    cross_x8(offset, along_b, side);
    add_scaled_x8(s->a0, clamp_to_unit_x8(dot_x8(side, normal) / area), along_a, point);
    at->v = nearest_on_segment_x8(point, s->b0, s->b1);
    add_scaled_x8(s->b0, at->v, along_b, point);
    at->u = nearest_on_segment_x8(point, s->a0, s->a1);
    return f64w_select(f64w_below(f64w_all(0.0), area), segment_distance_x8(s, *at),
                       f64w_all((double)INFINITY));
}

static inline f64w closest_ends_x8(const segments_x8 *s, parameters_x8 *out) {
    const f64w zero = f64w_all(0.0), one = f64w_all(1.0);
    const parameters_x8 candidates[4] = {{zero, nearest_on_segment_x8(s->a0, s->b0, s->b1)},
                                         {one, nearest_on_segment_x8(s->a1, s->b0, s->b1)},
                                         {nearest_on_segment_x8(s->b0, s->a0, s->a1), zero},
                                         {nearest_on_segment_x8(s->b1, s->a0, s->a1), one}};
    f64w best = f64w_all((double)INFINITY);
    *out = (parameters_x8){zero, zero};
    for (int i = 0; i < 4; i++) keep_nearer(segment_distance_x8(s, candidates[i]), candidates[i], &best, out);
    return best;
}

static inline parameters_x8 closest_segments_x8(const segments_x8 *s) {
    f64w size;
    parameters_x8 inner, outer;
    f64w distance = closest_on_lines_x8(s, &inner, &size);
    f64w best = closest_ends_x8(s, &outer);
    return inner_or_outer(distance, size, inner, best, outer);
}

/* ---- contacts ------------------------------------------------------------------------------------------ */

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
