/* Distances of features at rest, many pairs at a time, each with a proof: a plane across the nearest points.
 */
#include "runtime/kernels/feature_kernels.h"
#include "runtime/kernels/wide_pairs.h"

/* Nearest points of lanes: parameters as in cscd_contact, and the way from b's to a's. */
typedef struct nearest {
    f64w u, v, offset[3], squared;
} nearest;

static inline f64w clamp01(f64w x) {
    return f64w_max(f64w_min(x, f64w_all(1.0)), f64w_all(0.0));
}

/* Of the origin's way `to` along `side`: 0 where that has no length. */
static inline f64w share_along(const f64w to[3], const f64w side[3]) {
    f64w squared = dot(side, side), zero = f64w_all(0.0);
    return f64w_select(f64w_below(zero, squared), clamp01(dot(to, side) / squared), zero);
}

/* The way c - u a - v b. */
static inline nearest named(const f64w c[3], const f64w a[3], const f64w b[3], f64w u, f64w v) {
    nearest n = {.u = u, .v = v};
    for (int k = 0; k < 3; k++) n.offset[k] = c[k] - u * a[k] - v * b[k];
    n.squared = dot(n.offset, n.offset);
    return n;
}

static inline void take(uint32_t lanes, const nearest *from, nearest *to) {
    to->u = f64w_select(lanes, from->u, to->u);
    to->v = f64w_select(lanes, from->v, to->v);
    for (int k = 0; k < 3; k++) to->offset[k] = f64w_select(lanes, from->offset[k], to->offset[k]);
    to->squared = f64w_select(lanes, from->squared, to->squared);
}

static inline void take_nearer(const nearest *from, nearest *to) {
    take(f64w_below(from->squared, to->squared), from, to);
}

/* Adds the parameters of what the way at hand, from the plane of a and b to the point, projects to. */
static inline nearest project(const f64w c[3], const f64w a[3], const f64w b[3], const f64w normal[3],
                              f64w area, const nearest *at) {
    f64w side_u[3], side_v[3];
    cross(at->offset, b, side_u);
    cross(a, at->offset, side_v);
    return named(c, a, b, at->u + dot(side_u, normal) / area, at->v + dot(side_v, normal) / area);
}

/* A point c and the triangle of the origin, a and b. */
static inline nearest nearest_in_triangle(const f64w c[3], const f64w a[3], const f64w b[3]) {
    f64w zero = f64w_all(0.0), one = f64w_all(1.0), third[3], beyond[3], normal[3];
    for (int k = 0; k < 3; k++) {
        third[k] = b[k] - a[k];
        beyond[k] = c[k] - a[k];
    }
    f64w along = share_along(beyond, third);
    nearest best = named(c, a, b, share_along(c, a), zero);
    nearest other = named(c, a, b, zero, share_along(c, b));
    take_nearer(&other, &best);
    other = named(c, a, b, one - along, along);
    take_nearer(&other, &best);
    cross(a, b, normal);
    f64w area = dot(normal, normal);
    nearest inner = named(c, a, b, zero, zero);
    inner = project(c, a, b, normal, area, &inner);
    inner = project(c, a, b, normal, area, &inner); /* twice: thin triangles */
    uint32_t inside = f64w_below(zero, area) & f64w_at_most(zero, inner.u) & f64w_at_most(zero, inner.v) &
                      f64w_at_most(inner.u + inner.v, one);
    take(inside, &inner, &best);
    return best;
}

/* Two edges: a from the origin, and b from c on. The way between their points is u a - (c + v b). */
static inline nearest nearest_of_edges(const f64w c[3], const f64w a[3], const f64w b[3]) {
    f64w zero = f64w_all(0.0), one = f64w_all(1.0), back[3], from_end[3], to_end[3], normal[3], side[3];
    f64w minus_c[3], at_v[3];
    for (int k = 0; k < 3; k++) {
        minus_c[k] = zero - c[k];
        back[k] = zero - a[k];
        from_end[k] = a[k] - c[k];
        to_end[k] = c[k] + b[k];
    }
    nearest best = named(minus_c, back, b, zero, share_along(minus_c, b));
    nearest other = named(minus_c, back, b, one, share_along(from_end, b));
    take_nearer(&other, &best);
    other = named(minus_c, back, b, share_along(c, a), zero);
    take_nearer(&other, &best);
    other = named(minus_c, back, b, share_along(to_end, a), one);
    take_nearer(&other, &best);
    cross(a, b, normal);
    cross(c, b, side);
    f64w area = dot(normal, normal), u = clamp01(dot(side, normal) / area);
    for (int k = 0; k < 3; k++) side[k] = u * a[k] - c[k];
    f64w v = share_along(side, b);
    for (int k = 0; k < 3; k++) at_v[k] = c[k] + v * b[k];
    other = named(minus_c, back, b, share_along(at_v, a), v);
    take(f64w_below(zero, area) & f64w_at_most(other.squared, best.squared), &other, &best);
    return best;
}

/* How far the plane across the way keeps all points of the features apart. */
static inline f64w gap_across(const nearest *n, f64w distance, int first_count, const f64w c[3],
                              const f64w a[3], const f64w b[3]) {
    f64w zero = f64w_all(0.0), normal[3];
    for (int k = 0; k < 3; k++) normal[k] = n->offset[k] / distance;
    f64w along_a = dot(normal, a), along_b = dot(normal, b), along_c = dot(normal, c);
    if (first_count == 1) return along_c - f64w_max(zero, f64w_max(along_a, along_b));
    return f64w_min(zero, along_a) - along_c - f64w_max(zero, along_b);
}

static inline f64w extent_of(const f64w a[3], const f64w b[3], const f64w c[3]) {
    f64w largest = f64w_all(0.0);
    for (int k = 0; k < 3; k++)
        largest = f64w_max(largest, f64w_max(f64w_abs(a[k]), f64w_max(f64w_abs(b[k]), f64w_abs(c[k]))));
    return largest;
}

/* In units of 2^-53 of the extent E of a, b and c, which are off by 1 each: the way is off by 1 + 2 + 2 for
 * them, by 4 for the products and by 6 for the sums per coordinate, its length by twice that; dots with the
 * normal, itself off by 4 of 1, by 3 (1 + 4 + 3) each, three of them below 80. 2^-45 is 256. Distances
 * from 2^-40 E on then have a normal that is right to 2^-4 of that bound. Products of four lengths are far
 * from over- and underflow for E from 2^-100 to 2^100. */
static inline void decide(const wide_points *p, int first_count, int i, double limit, rest_outcomes *out) {
    f64w a[3], b[3], c[3];
    int vf = first_count == 1;
    for (int k = 0; k < 3; k++) {
        a[k] = p->x0[vf ? 2 : 1][k] - p->x0[vf ? 1 : 0][k];
        b[k] = p->x0[3][k] - p->x0[vf ? 1 : 2][k];
        c[k] = vf ? p->x0[0][k] - p->x0[1][k] : p->x0[2][k] - p->x0[0][k];
    }
    nearest n = vf ? nearest_in_triangle(c, a, b) : nearest_of_edges(c, a, b);
    f64w extent = extent_of(a, b, c), error = extent * 0x1p-45, distance = f64w_sqrt(n.squared);
    f64w gap = gap_across(&n, distance, first_count, c, a, b);
    uint32_t sound = f64w_below(f64w_all(0x1p-100), extent) & f64w_below(extent, f64w_all(0x1p100)) &
                     f64w_below(extent * 0x1p-40, distance);
    uint32_t apart = sound & f64w_below(f64w_all(limit), gap - error);
    uint32_t nearest_indeed = f64w_at_most(distance * (1.0 - 0x1p-24), gap + error);
    uint32_t near = sound & ~apart & nearest_indeed & f64w_at_most(distance + error, f64w_all(limit));
    out->misses |= apart << i;
    out->hits |= near << i;
    memcpy(out->u + i, &n.u, sizeof n.u);
    memcpy(out->v + i, &n.v, sizeof n.v);
    for (int k = 0; k < 3; k++) memcpy(out->offset[k] + i, &n.offset[k], sizeof n.offset[k]);
    memcpy(out->distance + i, &distance, sizeof distance);
}

static inline void decide_all(const feature_source *source, const uint32_t *a, const uint32_t *b,
                              int first_count, double limit, rest_outcomes *out) {
    out->misses = out->hits = 0;
    for (int i = 0; i < KERNEL_LANES; i += WIDTH) {
        wide_points points;
        (first_count == 1 ? load_vf : load_ee)(source, a + i, b + i, &points);
        decide(&points, first_count, i, limit, out);
    }
}

void SIMD_NAME(rest_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b, double distance,
                        rest_outcomes *out) {
    decide_all(source, a, b, 1, distance, out);
}

void SIMD_NAME(rest_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b, double distance,
                        rest_outcomes *out) {
    decide_all(source, a, b, 2, distance, out);
}
