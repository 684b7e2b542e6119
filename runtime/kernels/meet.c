/* Pairs of triangles that certainly do not meet, features that share a vertex aside: signs of determinants.
 *
 * Signs. u, v, w being differences of two coordinate triples each, the sign of (u x v) . w, computed as
 * orient3d computes it, is certain beyond 2^-50 times its magnitude, the same sum of absolute values, and the
 * sign of a component of u x v beyond 2^-51 times its own: src/predicates.c derives both bounds, which ask
 * for nothing but that every component is one rounded difference of coordinates, each of them 0 or in
 * [2^-300, 2^300], so that nothing over- or underflows. Where something does overflow, magnitudes are at
 * least as large as determinants, since rounding keeps order, so infinities and what is not a number certify
 * nothing.
 *
 * What counts follows runtime/triangle_intersection.c, which decides whatever is left open:
 *
 * Two shared vertices, (p, q, c) and (p, q, d): they do not meet when d is off the plane of pqc; nor when, in
 * a projection along an axis, c and d lie on different sides of the line pq. For then either triangle lies
 * on its side but for points of pq, c is in no point of the other, and pc and qd leave the line from
 * different ends.
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
 * e alone, of the other w alone, and w is on neither ab nor cd.
 *
 * None: edges against faces count. Boxes that do not overlap, or all corners of one strictly on one side of
 * the other's plane, say that nothing meets. An edge misses a face if its ends are strictly on one side of
 * the face's plane, or if its line passes two of the face's edges certainly on different sides: seen along
 * the line, a point of the face on it would be a convex combination of the corners, and all signs the same or
 * zero. If all six miss, the triangles do not meet. Nor do they when, in a projection along an axis, the line
 * of an edge has the third corner strictly on one side and all of the other triangle strictly on the other.
 */
#include "runtime/kernels/this_level.h"

/* ---- signs ------------------------------------------------------------------------------------------- */

typedef f64w wide_vector[3];

/* Sets of lanes: certainly above zero, certainly below. */
typedef struct wide_sign {
    uint32_t plus, minus;
} wide_sign;

/* A cross product, and the sums of the absolute values that its components are differences of. */
typedef struct wide_normal {
    wide_vector n, size;
} wide_normal;

static inline void from_to(const wide_vector from, const wide_vector to, wide_vector out) {
    for (int k = 0; k < 3; k++) out[k] = to[k] - from[k];
}

static inline void normal_of(const wide_vector u, const wide_vector v, wide_normal *out) {
    for (int k = 0; k < 3; k++) {
        f64w left = u[(k + 1) % 3] * v[(k + 2) % 3], right = u[(k + 2) % 3] * v[(k + 1) % 3];
        out->n[k] = left - right;
        out->size[k] = f64w_abs(left) + f64w_abs(right);
    }
}

static inline wide_sign sign_beyond(f64w value, f64w bound) {
    return (wide_sign){f64w_below(bound, value), f64w_below(value, -bound)};
}

/* Of (u x v) . w. */
static inline wide_sign side_of(const wide_normal *uv, const wide_vector w) {
    f64w value = uv->n[0] * w[0] + uv->n[1] * w[1] + uv->n[2] * w[2];
    f64w size = uv->size[0] * f64w_abs(w[0]) + uv->size[1] * f64w_abs(w[1]) + uv->size[2] * f64w_abs(w[2]);
    return sign_beyond(value, f64w_all(0x1p-50) * size);
}

/* Of a component of u x v. */
static inline wide_sign turn_of(const wide_normal *uv, int axis) {
    return sign_beyond(uv->n[axis], f64w_all(0x1p-51) * uv->size[axis]);
}

static inline wide_sign turn(const wide_vector u, const wide_vector v, int axis) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    f64w left = u[x] * v[y], right = u[y] * v[x];
    return sign_beyond(left - right, f64w_all(0x1p-51) * (f64w_abs(left) + f64w_abs(right)));
}

static inline uint32_t same(wide_sign a, wide_sign b) {
    return (a.plus & b.plus) | (a.minus & b.minus);
}

static inline uint32_t opposite(wide_sign a, wide_sign b) {
    return (a.plus & b.minus) | (a.minus & b.plus);
}

static inline uint32_t same_of_three(const wide_sign s[3]) {
    return (s[0].plus & s[1].plus & s[2].plus) | (s[0].minus & s[1].minus & s[2].minus);
}

/* Two of the three are certainly different, none of them zero. */
static inline uint32_t mixed(wide_sign a, wide_sign b, wide_sign c) {
    return (a.plus | b.plus | c.plus) & (a.minus | b.minus | c.minus);
}

/* ---- two shared vertices, and one -------------------------------------------------------------------- */

/* corners: of the one triangle, then of the other; either apex first. */
static inline uint32_t hinge_is_open(const wide_vector corners[6]) {
    const wide_vector *c = &corners[0], *p = &corners[1], *q = &corners[2], *d = &corners[3];
    wide_vector pq, pc, pd;
    wide_normal face, other;
    from_to(*p, *q, pq);
    from_to(*p, *c, pc);
    from_to(*p, *d, pd);
    normal_of(pq, pc, &face);
    wide_sign side = side_of(&face, pd);
    uint32_t apart = side.plus | side.minus;
    if (apart == ALL_WIDTH) return 0;
    normal_of(pq, pd, &other);
    for (int k = 0; k < 3; k++) apart |= opposite(turn_of(&face, k), turn_of(&other, k));
    return ALL_WIDTH & ~apart;
}

/* corners: the shared one first, in both. */
static inline void cones_of(const wide_vector corners[6], wide_vector cones[2][2]) {
    for (int i = 0; i < 4; i++) from_to(corners[0], corners[i < 2 ? 1 + i : 2 + i], cones[i / 2][i % 2]);
}

static inline uint32_t fan_is_open(const wide_vector corners[6]) {
    wide_vector cones[2][2];
    wide_normal ab, cd;
    cones_of(corners, cones);
    normal_of(cones[0][0], cones[0][1], &ab);
    wide_sign abc = side_of(&ab, cones[1][0]), abd = side_of(&ab, cones[1][1]);
    normal_of(cones[1][0], cones[1][1], &cd);
    wide_sign acd = side_of(&cd, cones[0][0]), bcd = side_of(&cd, cones[0][1]);
    uint32_t across = opposite(abc, abd) & opposite(acd, bcd) & opposite(abd, acd);
    return ALL_WIDTH & ~(same(abc, abd) | same(acd, bcd) | across);
}

static inline uint32_t flat_fan_is_open(const wide_vector corners[6]) {
    wide_vector cones[2][2];
    uint32_t apart = 0;
    cones_of(corners, cones);
    for (int k = 0; k < 3; k++) {
        wide_sign between[2][2], own[2];
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

static inline uint32_t boxes_apart(const wide_vector corners[6]) {
    const wide_vector *a = corners, *b = corners + 3;
    uint32_t apart = 0;
    for (int k = 0; k < 3; k++) {
        apart |= f64w_below(greatest(a[0][k], a[1][k], a[2][k]), least(b[0][k], b[1][k], b[2][k]));
        apart |= f64w_below(greatest(b[0][k], b[1][k], b[2][k]), least(a[0][k], a[1][k], a[2][k]));
    }
    return apart;
}

/* Edge i leads from corner i to corner i + 1. */
static inline void edges_of(const wide_vector corners[3], wide_vector out[3]) {
    for (int i = 0; i < 3; i++) from_to(corners[i], corners[(i + 1) % 3], out[i]);
}

/* The sides of the face's plane on which corners lie. */
static inline void sides_of(const wide_vector face[3], const wide_vector corners[3], wide_sign out[3]) {
    wide_vector u, v;
    wide_normal normal;
    from_to(face[0], face[1], u);
    from_to(face[0], face[2], v);
    normal_of(u, v, &normal);
    for (int i = 0; i < 3; i++) {
        wide_vector to_corner;
        from_to(face[0], corners[i], to_corner);
        out[i] = side_of(&normal, to_corner);
    }
}

static inline uint32_t free_is_open(const wide_vector corners[6]) {
    wide_sign sides[3];
    uint32_t apart = boxes_apart(corners);
    if (apart == ALL_WIDTH) return 0;
    sides_of(corners, corners + 3, sides);
    apart |= same_of_three(sides);
    if (apart == ALL_WIDTH) return 0;
    sides_of(corners + 3, corners, sides);
    return ALL_WIDTH & ~(apart | same_of_three(sides));
}

static inline uint32_t piercing_is_open(const wide_vector corners[6]) {
    const wide_vector *a = corners, *b = corners + 3;
    wide_vector edges_a[3], edges_b[3];
    wide_sign sides_a[3], sides_b[3], passes[3][3];
    uint32_t miss = ALL_WIDTH;
    edges_of(a, edges_a);
    edges_of(b, edges_b);
    sides_of(a, b, sides_b);
    sides_of(b, a, sides_a);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            wide_vector between;
            wide_normal normal;
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
static inline uint32_t parted_by_edge_of(const wide_vector a[3], const wide_vector b[3], int axis) {
    wide_vector edges[3];
    uint32_t apart = 0;
    edges_of(a, edges);
    wide_sign own = turn(edges[0], edges[1], axis);
    for (int i = 0; i < 3; i++) {
        wide_sign turns[3];
        for (int j = 0; j < 3; j++) {
            wide_vector between;
            from_to(a[i], b[j], between);
            turns[j] = turn(edges[i], between, axis);
        }
        apart |= same_of_three(turns) & opposite(own, turns[0]);
    }
    return apart;
}

static inline uint32_t flat_free_is_open(const wide_vector corners[6]) {
    uint32_t apart = 0;
    for (int k = 0; k < 3 && apart != ALL_WIDTH; k++)
        apart |= parted_by_edge_of(corners, corners + 3, k) | parted_by_edge_of(corners + 3, corners, k);
    return ALL_WIDTH & ~apart;
}

/* ---- lists ------------------------------------------------------------------------------------------- */

enum { CHUNK = 256, LIST_SIZE = CHUNK + WIDTH };

/* Pairs with a like number of shared vertices; their corners are turned so that the shared vertex, or the one
 * that is not shared, comes first. */
typedef struct pair_list {
    uint32_t corners[6][LIST_SIZE];
    triangle_pair pairs[LIST_SIZE];
    uint32_t count;
} pair_list;

/* For sets of corners that are shared: which comes first. */
static const uint8_t first_corner[8] = {0, 0, 1, 2, 2, 1, 0, 0};

static inline void add_pair(pair_list lists[4], const uint32_t (*triangles)[3], triangle_pair pair) {
    const uint32_t *a = triangles[pair.a], *b = triangles[pair.b];
    const uint32_t turned_a[5] = {a[0], a[1], a[2], a[0], a[1]}, turned_b[5] = {b[0], b[1], b[2], b[0], b[1]};
    uint32_t shared_a = 0, shared_b = 0, equal[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) equal[i][j] = a[i] == b[j];
    }
    for (int i = 0; i < 3; i++) {
        shared_a |= (equal[i][0] | equal[i][1] | equal[i][2]) << i;
        shared_b |= (equal[0][i] | equal[1][i] | equal[2][i]) << i;
    }
    pair_list *list = &lists[(shared_a & 1) + (shared_a >> 1 & 1) + (shared_a >> 2)];
    const uint32_t *from_a = turned_a + first_corner[shared_a], *from_b = turned_b + first_corner[shared_b];
    for (int i = 0; i < 3; i++) {
        list->corners[i][list->count] = from_a[i];
        list->corners[3 + i][list->count] = from_b[i];
    }
    list->pairs[list->count++] = pair;
}

/* Keeps the pairs that a test leaves open; what fills up the last vector is the last pair. */
static inline void keep_open(pair_list *list, const double *positions, uint32_t loaded,
                             uint32_t (*test)(const wide_vector corners[6])) {
    uint32_t kept = 0;
    for (uint32_t lane = 0; list->count > 0 && lane < WIDTH - 1; lane++) {
        for (int i = 0; i < 6; i++) list->corners[i][list->count + lane] = list->corners[i][list->count - 1];
    }
    for (uint32_t first = 0; first < list->count; first += WIDTH) {
        wide_vector corners[6];
        for (int i = 0; i < 6; i++) {
            if ((loaded >> i & 1) != 0) f64w_load_points(positions, list->corners[i] + first, corners[i]);
        }
        uint32_t rest = list->count - first, real = rest < WIDTH ? (1u << rest) - 1 : ALL_WIDTH;
        for (uint32_t open = test(corners) & real; open != 0; open &= open - 1) {
            uint32_t from = first + (uint32_t)__builtin_ctz(open);
            for (int i = 0; i < 6; i++) list->corners[i][kept] = list->corners[i][from];
            list->pairs[kept++] = list->pairs[from];
        }
    }
    list->count = kept;
}

/* Of each list, which corners are looked at. */
enum { FREE_CORNERS = 63, FAN_CORNERS = 1 + 2 + 4 + 16 + 32, HINGE_CORNERS = 1 + 2 + 4 + 8 };

uint32_t SIMD_NAME(keep_meeting)(const uint32_t (*triangles)[3], const double *positions,
                                 triangle_pair *pairs, uint32_t count) {
    pair_list lists[4];
    uint32_t kept = 0;
    for (uint32_t begin = 0; begin < count; begin += CHUNK) {
        uint32_t end = count - begin < CHUNK ? count : begin + CHUNK;
        for (int i = 0; i < 4; i++) lists[i].count = 0;
        for (uint32_t i = begin; i < end; i++) add_pair(lists, triangles, pairs[i]);
        keep_open(&lists[0], positions, FREE_CORNERS, free_is_open);
        keep_open(&lists[0], positions, FREE_CORNERS, piercing_is_open);
        keep_open(&lists[0], positions, FREE_CORNERS, flat_free_is_open);
        keep_open(&lists[1], positions, FAN_CORNERS, fan_is_open);
        keep_open(&lists[1], positions, FAN_CORNERS, flat_fan_is_open);
        keep_open(&lists[2], positions, HINGE_CORNERS, hinge_is_open);
        for (int i = 0; i < 3; i++) { /* three shared vertices: nothing is left to meet */
            memcpy(pairs + kept, lists[i].pairs, lists[i].count * sizeof *pairs);
            kept += lists[i].count;
        }
    }
    return kept;
}

/* ---- single triangles -------------------------------------------------------------------------------- */

uint32_t SIMD_NAME(keep_thin)(const uint32_t (*triangles)[3], const double *positions, uint32_t *list,
                              uint32_t count) {
    uint32_t kept = 0;
    for (uint32_t first = 0; first < count; first += WIDTH) {
        uint32_t rest = count - first, real = rest < WIDTH ? (1u << rest) - 1 : ALL_WIDTH, clear = 0;
        uint32_t vertices[3][WIDTH];
        wide_vector corners[3], u, v;
        wide_normal normal;
        for (uint32_t lane = 0; lane < WIDTH; lane++) {
            const uint32_t *triangle = triangles[list[lane < rest ? first + lane : first]];
            for (int i = 0; i < 3; i++) vertices[i][lane] = triangle[i];
        }
        for (int i = 0; i < 3; i++) f64w_load_points(positions, vertices[i], corners[i]);
        from_to(corners[0], corners[1], u);
        from_to(corners[0], corners[2], v);
        normal_of(u, v, &normal);
        for (int k = 0; k < 3; k++) {
            wide_sign sign = turn_of(&normal, k);
            clear |= sign.plus | sign.minus;
        }
        for (uint32_t open = real & ~clear; open != 0; open &= open - 1)
            list[kept++] = list[first + (uint32_t)__builtin_ctz(open)];
    }
    return kept;
}
