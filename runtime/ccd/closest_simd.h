/* Closest points of many pairs of features at rest. The twin of closest.c: the same operations in the same order, so the same
 * bits. Where closest.c returns early, lanes go on and their results are not taken. */
#pragma once

#include "runtime/ccd/vectors_simd.h"

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

/* Takes the inner points unless the ones on sides or ends, whose distance is `best`, are nearer. When rounding hides the
 * difference, the inner points are the better ones; below this share of the squared lengths the distance is rounding. */
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
