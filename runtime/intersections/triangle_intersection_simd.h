/* Pairs of triangles that certainly do not meet, features that share a vertex aside: signs of determinants.
 *
 * Signs. u, v, w being differences of two coordinate triples each, the sign of (u x v) . w, computed as
 * orient3d computes it, is certain beyond 2^-50 times its magnitude, the same sum of absolute values, and the
 * sign of a component of u x v beyond 2^-51 times its own: src/mesh/predicates.c derives both bounds, which ask
 * for nothing but that every component is one rounded difference of coordinates, each of them 0 or in
 * [2^-300, 2^300], so that nothing over- or underflows. Where something does overflow, magnitudes are at
 * least as large as determinants, since rounding keeps order, so infinities and what is not a number certify
 * nothing.
 *
 * What counts follows src/mesh/triangle_intersection.c, which decides whatever is left open:
 *
 * Two shared vertices, (p, q, c) and (p, q, d): they do not meet when d is off the plane of pqc; nor when, in
 * a projection along an axis, c and d lie on different sides of the line pq. For then either triangle lies
 * on its side but for pq, so neither holds the other's apex, and pc and qd leave the line from different
 * ends.
 *
 * One, (w, a, b) and (w, c, d): ab against (w, c, d) and cd against (w, a, b) count. Either triangle is part
 * of the cone from w that its other corners span. With a, b, c, d taken from w, and [abc] = (a x b) . c: if c
 * and d lie strictly on one side of the plane of a and b, or these of the plane of c and d, the cones have
 * nothing but w in common, and w is neither on ab nor on cd. Else, if all four signs are certain, both cones
 * reach the line in which the planes meet: (a x b) x (c x d) = [abd] c - [abc] d = [acd] b - [bcd] a is a
 * positive combination of c and d or, with the other sign, of minus these, and likewise of a and b; so the
 * cones reach it on different sides of w when [abd] and [acd] have different signs. Nor do they meet when, in
 * a projection along an axis, the line of one spanning vector e has the other vector of e's cone strictly on
 * one side and both of the other cone strictly on the other: of its own cone the line holds points of the ray
 * e alone, of the other w alone, and w is on neither ab nor cd. Nor when a and b lie strictly on one side of
 * a plane through w, and c and d on the other. Its normal g may be any, so g is exact; a product with g
 * carries one difference, three products and two sums, each term four roundings, less than 2^-50 of its
 * magnitude.
 *
 * None: edges against faces count. Boxes that do not overlap, or all corners of one strictly on one side of
 * the other's plane, say that nothing meets. An edge misses a face if its ends are strictly on one side of
 * the face's plane, or if its line passes two of the face's edges certainly on different sides: seen along
 * the line, a point of the face on it would be a convex combination of the corners, and all signs the same or
 * zero. If all six miss, the triangles do not meet. Nor do they when, in a projection along an axis, the line
 * of an edge has the third corner strictly on one side and all of the other triangle strictly on the other.
 */
#pragma once

#include "src/core/simd.h"

/* ---- signs ------------------------------------------------------------------------------------------- */

typedef f64w vector_x8[3];

/* Sets of lanes: certainly above zero, certainly below. */
typedef struct sign_x8 {
    uint32_t plus, minus;
} sign_x8;

/* A cross product, and the sums of the absolute values that its components are differences of. */
typedef struct normal_x8 {
    vector_x8 n, size;
} normal_x8;

static inline void from_to(const vector_x8 from, const vector_x8 to, vector_x8 out) {
    for (int k = 0; k < 3; k++) out[k] = to[k] - from[k];
}

static inline void normal_of(const vector_x8 u, const vector_x8 v, normal_x8 *out) {
    for (int k = 0; k < 3; k++) {
        f64w left = u[(k + 1) % 3] * v[(k + 2) % 3], right = u[(k + 2) % 3] * v[(k + 1) % 3];
        out->n[k] = left - right;
        out->size[k] = f64w_abs(left) + f64w_abs(right);
    }
}

static inline sign_x8 sign_beyond(f64w value, f64w bound) {
    return (sign_x8){f64w_below(bound, value), f64w_below(value, -bound)};
}

static inline f64w dot(const vector_x8 a, const vector_x8 b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Of (u x v) . w. */
static inline sign_x8 side_of(const normal_x8 *uv, const vector_x8 w) {
    vector_x8 size = {f64w_abs(w[0]), f64w_abs(w[1]), f64w_abs(w[2])};
    return sign_beyond(dot(uv->n, w), f64w_all(0x1p-50) * dot(uv->size, size));
}

/* Of a component of u x v. */
static inline sign_x8 turn_of(const normal_x8 *uv, int axis) {
    return sign_beyond(uv->n[axis], f64w_all(0x1p-51) * uv->size[axis]);
}

static inline sign_x8 turn(const vector_x8 u, const vector_x8 v, int axis) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    f64w left = u[x] * v[y], right = u[y] * v[x];
    return sign_beyond(left - right, f64w_all(0x1p-51) * (f64w_abs(left) + f64w_abs(right)));
}

static inline uint32_t same(sign_x8 a, sign_x8 b) {
    return (a.plus & b.plus) | (a.minus & b.minus);
}

static inline uint32_t opposite(sign_x8 a, sign_x8 b) {
    return (a.plus & b.minus) | (a.minus & b.plus);
}

static inline uint32_t same_of_three(const sign_x8 s[3]) {
    return (s[0].plus & s[1].plus & s[2].plus) | (s[0].minus & s[1].minus & s[2].minus);
}

/* Two of the three are certainly different, none of them zero. */
static inline uint32_t mixed(sign_x8 a, sign_x8 b, sign_x8 c) {
    return (a.plus | b.plus | c.plus) & (a.minus | b.minus | c.minus);
}

/* ---- two shared vertices, and one -------------------------------------------------------------------- */

/* corners: of the one triangle, then of the other; either apex first. */
static inline uint32_t hinge_is_open(const vector_x8 corners[6]) {
    const vector_x8 *c = &corners[0], *p = &corners[1], *q = &corners[2], *d = &corners[3];
    vector_x8 pq, pc, pd;
    normal_x8 face, other;
    from_to(*p, *q, pq);
    from_to(*p, *c, pc);
    from_to(*p, *d, pd);
    normal_of(pq, pc, &face);
    sign_x8 side = side_of(&face, pd);
    uint32_t apart = side.plus | side.minus;
    if (apart == ALL_WIDTH) return 0;
    normal_of(pq, pd, &other);
    for (int k = 0; k < 3; k++) apart |= opposite(turn_of(&face, k), turn_of(&other, k));
    return ALL_WIDTH & ~apart;
}

/* corners: the shared one first, in both. */
static inline void cones_of(const vector_x8 corners[6], vector_x8 cones[2][2]) {
    for (int i = 0; i < 4; i++) from_to(corners[0], corners[i < 2 ? 1 + i : 2 + i], cones[i / 2][i % 2]);
}

static inline uint32_t fan_is_open(const vector_x8 corners[6]) {
    vector_x8 cones[2][2];
    normal_x8 ab, cd;
    cones_of(corners, cones);
    normal_of(cones[0][0], cones[0][1], &ab);
    sign_x8 abc = side_of(&ab, cones[1][0]), abd = side_of(&ab, cones[1][1]);
    if (same(abc, abd) == ALL_WIDTH) return 0;
    normal_of(cones[1][0], cones[1][1], &cd);
    sign_x8 acd = side_of(&cd, cones[0][0]), bcd = side_of(&cd, cones[0][1]);
    uint32_t across = opposite(abc, abd) & opposite(acd, bcd) & opposite(abd, acd);
    return ALL_WIDTH & ~(same(abc, abd) | same(acd, bcd) | across);
}

/* A plane through w, wherever it is, with a and b strictly on one side and c and d on the other. */
static inline uint32_t fan_is_open_x8(const vector_x8 corners[6]) {
    vector_x8 cones[2][2], across, size;
    uint32_t apart = ALL_WIDTH;
    cones_of(corners, cones);
    for (int k = 0; k < 3; k++) {
        across[k] = (cones[0][0][k] + cones[0][1][k]) - (cones[1][0][k] + cones[1][1][k]);
        size[k] = f64w_abs(across[k]);
    }
    for (int i = 0; i < 4; i++) {
        const vector_x8 *e = &cones[i / 2][i % 2];
        vector_x8 size_e = {f64w_abs((*e)[0]), f64w_abs((*e)[1]), f64w_abs((*e)[2])};
        sign_x8 side = sign_beyond(dot(across, *e), f64w_all(0x1p-50) * dot(size, size_e));
        apart &= i < 2 ? side.plus : side.minus;
    }
    return ALL_WIDTH & ~apart;
}

static inline uint32_t flat_fan_is_open(const vector_x8 corners[6]) {
    vector_x8 cones[2][2];
    uint32_t apart = 0;
    cones_of(corners, cones);
    for (int k = 0; k < 3; k++) {
        sign_x8 between[2][2], own[2];
        for (int i = 0; i < 2; i++) {
            for (int j = 0; j < 2; j++) between[i][j] = turn(cones[0][i], cones[1][j], k);
            own[i] = turn(cones[i][0], cones[i][1], k);
        }
        /* The turn from e to the cone's other vector: own, for the second vector with the other sign; that
         * from e to a vector of the other cone: between, for the second cone with the other sign. */
        for (int i = 0; i < 2; i++) {
            uint32_t of_first = same(between[i][0], between[i][1]),
                     of_second = same(between[0][i], between[1][i]);
            apart |= of_first & (i == 0 ? opposite : same)(own[0], between[i][0]);
            apart |= of_second & (i == 0 ? same : opposite)(own[1], between[0][i]);
        }
    }
    return ALL_WIDTH & ~apart;
}

/* ---- no shared vertex -------------------------------------------------------------------------------- */

static inline f64w least(f64w a, f64w b, f64w c) {
    return f64w_min(f64w_min(a, b), c);
}

static inline f64w greatest(f64w a, f64w b, f64w c) {
    return f64w_max(f64w_max(a, b), c);
}

static inline uint32_t boxes_apart(const vector_x8 corners[6]) {
    const vector_x8 *a = corners, *b = corners + 3;
    uint32_t apart = 0;
    for (int k = 0; k < 3; k++) {
        apart |= f64w_below(greatest(a[0][k], a[1][k], a[2][k]), least(b[0][k], b[1][k], b[2][k]));
        apart |= f64w_below(greatest(b[0][k], b[1][k], b[2][k]), least(a[0][k], a[1][k], a[2][k]));
    }
    return apart;
}

/* Edge i leads from corner i to corner i + 1. */
static inline void edges_of(const vector_x8 corners[3], vector_x8 out[3]) {
    for (int i = 0; i < 3; i++) from_to(corners[i], corners[(i + 1) % 3], out[i]);
}

/* The sides of the face's plane on which corners lie. */
static inline void sides_of(const vector_x8 face[3], const vector_x8 corners[3], sign_x8 out[3]) {
    vector_x8 u, v;
    normal_x8 normal;
    from_to(face[0], face[1], u);
    from_to(face[0], face[2], v);
    normal_of(u, v, &normal);
    for (int i = 0; i < 3; i++) {
        vector_x8 to_corner;
        from_to(face[0], corners[i], to_corner);
        out[i] = side_of(&normal, to_corner);
    }
}

static inline uint32_t free_is_open(const vector_x8 corners[6]) {
    sign_x8 sides[3];
    uint32_t apart = boxes_apart(corners);
    if (apart == ALL_WIDTH) return 0;
    sides_of(corners, corners + 3, sides);
    apart |= same_of_three(sides);
    if (apart == ALL_WIDTH) return 0;
    sides_of(corners + 3, corners, sides);
    return ALL_WIDTH & ~(apart | same_of_three(sides));
}

static inline uint32_t piercing_is_open(const vector_x8 corners[6]) {
    const vector_x8 *a = corners, *b = corners + 3;
    vector_x8 edges_a[3], edges_b[3];
    sign_x8 sides_a[3], sides_b[3], passes[3][3];
    uint32_t miss = ALL_WIDTH;
    edges_of(a, edges_a);
    edges_of(b, edges_b);
    sides_of(a, b, sides_b);
    sides_of(b, a, sides_a);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            vector_x8 between;
            normal_x8 normal;
            from_to(a[i], b[j], between);
            normal_of(edges_a[i], edges_b[j], &normal);
            passes[i][j] = side_of(&normal, between);
        }
    }
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        miss &= same(sides_a[i], sides_a[next]) | mixed(passes[i][0], passes[i][1], passes[i][2]);
        miss &= same(sides_b[i], sides_b[next]) | mixed(passes[0][i], passes[1][i], passes[2][i]);
    }
    return ALL_WIDTH & ~miss;
}

/* A line through an edge of a has b strictly on the one side, and a's third corner on the other. */
static inline uint32_t parted_by_edge_of(const vector_x8 a[3], const vector_x8 b[3], int axis) {
    vector_x8 edges[3];
    uint32_t apart = 0;
    edges_of(a, edges);
    sign_x8 own = turn(edges[0], edges[1], axis);
    for (int i = 0; i < 3; i++) {
        sign_x8 turns[3];
        for (int j = 0; j < 3; j++) {
            vector_x8 between;
            from_to(a[i], b[j], between);
            turns[j] = turn(edges[i], between, axis);
        }
        apart |= same_of_three(turns) & opposite(own, turns[0]);
    }
    return apart;
}

/* Where all corners are certainly off the plane, the edges have been asked already. */
static inline uint32_t flat_free_is_open(const vector_x8 corners[6]) {
    sign_x8 sides[3];
    uint32_t apart = 0, flat = 0;
    sides_of(corners, corners + 3, sides);
    for (int i = 0; i < 3; i++) flat |= ALL_WIDTH & ~(sides[i].plus | sides[i].minus);
    for (int k = 0; k < 3 && (flat & ~apart) != 0; k++)
        apart |= parted_by_edge_of(corners, corners + 3, k) | parted_by_edge_of(corners + 3, corners, k);
    return ALL_WIDTH & ~(flat & apart);
}
