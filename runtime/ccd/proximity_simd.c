/* Distances of features at rest, many pairs at a time, each with a proof: a plane across the nearest points.
 */
#include "runtime/ccd/ccd_simd.h"
#include "runtime/ccd/cubic_simd.h"
#include "src/core/vec3.h"

/* Nearest points of lanes: parameters as in cscd_contact, and the offset from b's to a's. */
typedef struct nearest {
    f64w u, v, offset[3], squared;
} nearest;

static inline f64w clamp_to_unit(f64w x) {
    return f64w_max(f64w_min(x, f64w_all(1.0)), f64w_all(0.0));
}

/* The share of `side` up to the point nearest to `to`, both from the origin; 0 where side has no length. */
static inline f64w share_along(const f64w to[3], const f64w side[3]) {
    f64w squared = dot_x8(side, side), zero = f64w_all(0.0);
    return maskw_choose(maskw_below(zero, squared), clamp_to_unit(dot_x8(to, side) / squared), zero);
}

/* The offset c - u a - v b. */
static inline nearest offset_between(const f64w c[3], const f64w a[3], const f64w b[3], f64w u, f64w v) {
    nearest n = {.u = u, .v = v};
    for (int k = 0; k < 3; k++) n.offset[k] = c[k] - u * a[k] - v * b[k];
    n.squared = dot_x8(n.offset, n.offset);
    return n;
}

static inline void take_lanes(maskw lanes, const nearest *from, nearest *to) {
    to->u = maskw_choose(lanes, from->u, to->u);
    to->v = maskw_choose(lanes, from->v, to->v);
    for (int k = 0; k < 3; k++) to->offset[k] = maskw_choose(lanes, from->offset[k], to->offset[k]);
    to->squared = maskw_choose(lanes, from->squared, to->squared);
}

static inline void take_nearer(const nearest *from, nearest *to) {
    take_lanes(maskw_below(from->squared, to->squared), from, to);
}

/* Projects the offset onto the plane of a and b, and adds the result to the parameters. */
static inline nearest add_projection(const f64w c[3], const f64w a[3], const f64w b[3], const f64w normal[3],
                                     f64w area, const nearest *at) {
    f64w side_u[3], side_v[3];
    cross_x8(at->offset, b, side_u);
    cross_x8(a, at->offset, side_v);
    return offset_between(c, a, b, at->u + dot_x8(side_u, normal) / area,
                          at->v + dot_x8(side_v, normal) / area);
}

/* A point c and the triangle of the origin, a and b. */
static inline nearest nearest_in_triangle(const f64w c[3], const f64w a[3], const f64w b[3]) {
    f64w zero = f64w_all(0.0), one = f64w_all(1.0), third[3], beyond[3], normal[3];
    for (int k = 0; k < 3; k++) {
        third[k] = b[k] - a[k];
        beyond[k] = c[k] - a[k];
    }
    f64w along = share_along(beyond, third);
    nearest best = offset_between(c, a, b, share_along(c, a), zero);
    nearest other = offset_between(c, a, b, zero, share_along(c, b));
    take_nearer(&other, &best);
    other = offset_between(c, a, b, one - along, along);
    take_nearer(&other, &best);
    cross_x8(a, b, normal);
    f64w area = dot_x8(normal, normal);
    nearest inner = offset_between(c, a, b, zero, zero);
    inner = add_projection(c, a, b, normal, area, &inner);
    inner = add_projection(c, a, b, normal, area, &inner); /* twice: thin triangles */
    maskw inside = maskw_below(zero, area) & maskw_at_most(zero, inner.u) & maskw_at_most(zero, inner.v) &
                   maskw_at_most(inner.u + inner.v, one);
    take_lanes(inside, &inner, &best);
    return best;
}

/* Two edges: a from the origin, and b from c on. The offset between their points is u a - (c + v b). */
static inline nearest nearest_of_edges(const f64w c[3], const f64w a[3], const f64w b[3]) {
    f64w zero = f64w_all(0.0), one = f64w_all(1.0), back[3], from_end[3], to_end[3], normal[3], side[3];
    f64w minus_c[3], at_v[3];
    for (int k = 0; k < 3; k++) {
        minus_c[k] = zero - c[k];
        back[k] = zero - a[k];
        from_end[k] = a[k] - c[k];
        to_end[k] = c[k] + b[k];
    }
    nearest best = offset_between(minus_c, back, b, zero, share_along(minus_c, b));
    nearest other = offset_between(minus_c, back, b, one, share_along(from_end, b));
    take_nearer(&other, &best);
    other = offset_between(minus_c, back, b, share_along(c, a), zero);
    take_nearer(&other, &best);
    other = offset_between(minus_c, back, b, share_along(to_end, a), one);
    take_nearer(&other, &best);
    cross_x8(a, b, normal);
    cross_x8(c, b, side);
    f64w area = dot_x8(normal, normal), u = clamp_to_unit(dot_x8(side, normal) / area);
    for (int k = 0; k < 3; k++) side[k] = u * a[k] - c[k];
    f64w v = share_along(side, b);
    for (int k = 0; k < 3; k++) at_v[k] = c[k] + v * b[k];
    other = offset_between(minus_c, back, b, share_along(at_v, a), v);
    take_lanes(maskw_below(zero, area) & maskw_at_most(other.squared, best.squared), &other, &best);
    return best;
}

/* A unit vector along the offset. */
static inline void direction_of(const nearest *n, f64w distance, f64w out[3]) {
    for (int k = 0; k < 3; k++) out[k] = n->offset[k] / distance;
}

/* Returns how far planes across a direction keep all points of the features apart. */
static inline f64w gap_along(const f64w direction[3], cscd_contact_kind kind, const f64w c[3],
                             const f64w a[3], const f64w b[3]) {
    f64w zero = f64w_all(0.0);
    f64w along_a = dot_x8(direction, a), along_b = dot_x8(direction, b), along_c = dot_x8(direction, c);
    if (kind == CSCD_CONTACT_VF) return along_c - f64w_max(zero, f64w_max(along_a, along_b));
    return f64w_min(zero, along_a) - along_c - f64w_max(zero, along_b);
}

static inline f64w extent_of(const f64w a[3], const f64w b[3], const f64w c[3]) {
    f64w largest = f64w_all(0.0);
    for (int k = 0; k < 3; k++)
        largest = f64w_max(largest, f64w_max(f64w_abs(a[k]), f64w_max(f64w_abs(b[k]), f64w_abs(c[k]))));
    return largest;
}

/* The powers of two that bring what is not 0 to [1/2, 1): exact factors, so that results are those of any
 * other scale, and products neither over- nor underflow. */
static inline f64w to_one(f64w extent) {
    const int64_t exponent = 0x7ff0000000000000, largest = 2045;
    i64w bits =
        ((i64w){0} + (largest << 52)) - ((i64w)extent & exponent); /* of 2^-e, for an extent below 2^e */
    return maskw_choose(maskw_at_most(f64w_all(0x1p-1022), extent), (f64w)bits, f64w_all(1.0));
}

/* 1 / x of powers of two from 2^-1022 to 2^1022, exactly: the exponent, 1023 + e, becomes 1023 - e. */
static inline f64w inverse_of_power(f64w x) {
    i64w bits = ((i64w){0} + 0x7fe0000000000000) - (i64w)x;
    return (f64w)bits;
}

/* The vectors between the points at one end: a vertex c and the triangle of a and b, or the edge a and the
 * edge b that begins at c. */
typedef struct vectors_at_end {
    f64w a[3], b[3], c[3];
} vectors_at_end;

static inline void vectors_at(f64w x[4][3], cscd_contact_kind kind, vectors_at_end *out) {
    int vf = kind == CSCD_CONTACT_VF;
    for (int k = 0; k < 3; k++) {
        out->a[k] = x[vf ? 2 : 1][k] - x[vf ? 1 : 0][k];
        out->b[k] = x[3][k] - x[vf ? 1 : 2][k];
        out->c[k] = vf ? x[0][k] - x[1][k] : x[2][k] - x[0][k];
    }
}

static inline void scale_vectors(vectors_at_end *v, f64w factor) {
    for (int k = 0; k < 3; k++) {
        v->a[k] *= factor;
        v->b[k] *= factor;
        v->c[k] *= factor;
    }
}

static inline void store_nearest(const nearest *n, f64w distance, f64w back, int i, proximity_outcomes *out) {
    memcpy(out->u + i, &n->u, sizeof n->u);
    memcpy(out->v + i, &n->v, sizeof n->v);
    distance *= back;
    memcpy(out->distance + i, &distance, sizeof distance);
    for (int k = 0; k < 3; k++) {
        f64w offset = n->offset[k] * back;
        memcpy(out->offset[k] + i, &offset, sizeof offset);
    }
}

/* The vectors at the start and at the end, which are the same at one moment, brought below 1. */
typedef struct vectors_at_ends {
    vectors_at_end start, end;
    f64w factor;
} vectors_at_ends;

static inline void vectors_at_moment(points_x8 *p, cscd_contact_kind kind, vectors_at_ends *out) {
    vectors_at(p->x0, kind, &out->start);
    out->factor = to_one(extent_of(out->start.a, out->start.b, out->start.c));
    scale_vectors(&out->start, out->factor);
}

static inline void vectors_at_both(points_x8 *p, cscd_contact_kind kind, vectors_at_ends *out) {
    vectors_at_end *start = &out->start, *end = &out->end;
    vectors_at(p->x0, kind, start);
    vectors_at(p->x1, kind, end);
    out->factor =
        to_one(f64w_max(extent_of(start->a, start->b, start->c), extent_of(end->a, end->b, end->c)));
    scale_vectors(start, out->factor);
    scale_vectors(end, out->factor);
}

static inline nearest nearest_of(const vectors_at_end *v, cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_VF ? nearest_in_triangle(v->c, v->a, v->b)
                                   : nearest_of_edges(v->c, v->a, v->b);
}

/* Vectors below 1 at both ends. In units of 2^-53: they are off by 1 each; the offset is off by 1 + 2 + 2
 * for them, by 4 for the products and by 6 for the sums per coordinate, its length by twice that; dots with
 * the direction, itself off by 4 of 1, by 3 (1 + 4 + 3) each, three of them below 80. 2^-45 is 256.
 * Distances from 2^-40 on then have a direction that is right to 2^-4 of that bound. Along one direction the
 * gap is the least of differences that are linear in time, so it is least at an end. Pairs that come within
 * the tolerance are left to the test that knows it. So are those within 2^-38 beyond it: no point is farther
 * than 2 from the first one, so the finest tolerance (SEPARATION_FINEST) is less, and at the next start the
 * pair surely exceeds its distance, by 2^-40 of that extent (floors.md, lemma 3). */
static inline void decide_proximity(points_x8 *p, cscd_contact_kind kind, bool moment, int i,
                                    const separations_x8 *limits, proximity_outcomes *out) {
    vectors_at_ends v;
    f64w limit, tolerance;
    memcpy(&limit, limits->distance + i, sizeof limit);
    memcpy(&tolerance, limits->tolerance + i, sizeof tolerance);
    f64w error = f64w_all(0x1p-45), direction[3];
    if (moment)
        vectors_at_moment(p, kind, &v);
    else
        vectors_at_both(p, kind, &v);
    f64w near = limit * v.factor;
    f64w far = near + tolerance * v.factor + 0x1p-38;
    nearest n = nearest_of(&v.start, kind);
    f64w distance = f64w_sqrt(n.squared);
    direction_of(&n, distance, direction);
    f64w gap = gap_along(direction, kind, v.start.c, v.start.a, v.start.b), least = gap;
    if (!moment) least = f64w_min(gap, gap_along(direction, kind, v.end.c, v.end.a, v.end.b));
    uint32_t sound = f64w_below(f64w_all(0x1p-40), distance);
    uint32_t nearest_indeed = f64w_at_most(distance * (1.0 - 0x1p-24), gap + error);
    out->apart |= (sound & f64w_below(far, least - error)) << i;
    out->within |= (sound & nearest_indeed & f64w_at_most(distance + error, near)) << i;
    store_nearest(&n, distance, inverse_of_power(v.factor), i, out);
}

/* Both ends are one moment where their positions are the same array. */
static inline void decide_eight_by_proximity(const feature_source *source, const uint32_t *a,
                                             const uint32_t *b, cscd_contact_kind kind, bool moment,
                                             const separations_x8 *limits, proximity_outcomes *out) {
    out->apart = out->within = 0;
    for (int i = 0; i < LANES; i += WIDTH) {
        points_x8 points;
        if (moment)
            load_features_at_start(source, kind, a + i, b + i, &points);
        else
            load_features(source, kind, a + i, b + i, &points);
        decide_proximity(&points, kind, moment, i, limits, out);
    }
}

void SIMD_NAME(proximity_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                             const separations_x8 *limits, proximity_outcomes *out) {
    if (source->x0 == source->x1)
        decide_eight_by_proximity(source, a, b, CSCD_CONTACT_VF, true, limits, out);
    else
        decide_eight_by_proximity(source, a, b, CSCD_CONTACT_VF, false, limits, out);
}

void SIMD_NAME(proximity_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                             const separations_x8 *limits, proximity_outcomes *out) {
    if (source->x0 == source->x1)
        decide_eight_by_proximity(source, a, b, CSCD_CONTACT_EE, true, limits, out);
    else
        decide_eight_by_proximity(source, a, b, CSCD_CONTACT_EE, false, limits, out);
}

/* ---- nearest points ---------------------------------------------------------------------------------------- */

/* The same operations as connection_length, of a vector that is not 0. */
static inline f64w length_of(const f64w v[3]) {
    f64w largest = f64w_max(f64w_abs(v[0]), f64w_max(f64w_abs(v[1]), f64w_abs(v[2]))), scaled[3];
    for (int k = 0; k < 3; k++) scaled[k] = v[k] / largest;
    return largest * f64w_sqrt(dot_x8(scaled, scaled));
}

/* The offset is what connection_between sums up from the weights of the points, up to the power of two, and divided by its length
 * it is what decide_proximity has compared with the limit. */
static inline void find_eight_nearest(const feature_source *source, const uint32_t *a, const uint32_t *b,
                                      cscd_contact_kind kind, nearest_points_x8 *out) {
    for (int i = 0; i < LANES; i += WIDTH) {
        points_x8 points;
        vectors_at_ends v;
        f64w normal[3];
        load_features_at_start(source, kind, a + i, b + i, &points);
        vectors_at_moment(&points, kind, &v);
        nearest n = nearest_of(&v.start, kind);
        f64w distance = length_of(n.offset) * inverse_of_power(v.factor);
        direction_of(&n, f64w_sqrt(n.squared), normal);
        memcpy(out->u + i, &n.u, sizeof n.u);
        memcpy(out->v + i, &n.v, sizeof n.v);
        memcpy(out->distance + i, &distance, sizeof distance);
        for (int k = 0; k < 3; k++) memcpy(out->normal[k] + i, &normal[k], sizeof normal[k]);
    }
}

void SIMD_NAME(nearest_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                           nearest_points_x8 *out) {
    find_eight_nearest(source, a, b, CSCD_CONTACT_VF, out);
}

void SIMD_NAME(nearest_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                           nearest_points_x8 *out) {
    find_eight_nearest(source, a, b, CSCD_CONTACT_EE, out);
}
