/* Rejects pairs of triangles that certainly do not intersect, features that share a vertex aside, by signs of determinants;
 * and finds the signs of normals.
 *
 * docs/theory/static-check.md proves which signs are certain and what follows from them; the functions cite its lemmas.
 * Coordinates are 0 or of a magnitude in [2^-300, 2^300]. src/mesh/triangle_intersection.c decides the pairs that are left
 * undecided here. Pairs are sorted by the number of vertices that they share, and as many of them are tested at a time as a
 * register of doubles holds. */
#include "runtime/intersections/static_check.h"

#include "src/core/simd_wide.h"

/* ---- signs --------------------------------------------------------------------------------------------- */

typedef f64w vector_x8[3];

/* Sets of lanes: those that are certainly above zero, and those that are certainly below. */
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

static inline f64w dot_x8(const vector_x8 a, const vector_x8 b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns the sign of (u x v) . w (Lemma 6). */
static inline sign_x8 side_of(const normal_x8 *uv, const vector_x8 w) {
    vector_x8 size = {f64w_abs(w[0]), f64w_abs(w[1]), f64w_abs(w[2])};
    return sign_beyond(dot_x8(uv->n, w), f64w_all(0x1p-50) * dot_x8(uv->size, size));
}

/* Returns the sign of a component of u x v (Lemma 6). */
static inline sign_x8 turn_of(const normal_x8 *uv, int axis) {
    return sign_beyond(uv->n[axis], f64w_all(0x1p-51) * uv->size[axis]);
}

static inline sign_x8 turn_between(const vector_x8 u, const vector_x8 v, int axis) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    f64w left = u[x] * v[y], right = u[y] * v[x];
    return sign_beyond(left - right, f64w_all(0x1p-51) * (f64w_abs(left) + f64w_abs(right)));
}

static inline uint32_t same_sign(sign_x8 a, sign_x8 b) {
    return (a.plus & b.plus) | (a.minus & b.minus);
}

static inline uint32_t opposite_signs(sign_x8 a, sign_x8 b) {
    return (a.plus & b.minus) | (a.minus & b.plus);
}

static inline uint32_t same_sign_of_three(const sign_x8 s[3]) {
    return (s[0].plus & s[1].plus & s[2].plus) | (s[0].minus & s[1].minus & s[2].minus);
}

/* Returns the lanes in which two of three signs are certainly different, and neither of these two is zero. */
static inline uint32_t mixed_signs(sign_x8 a, sign_x8 b, sign_x8 c) {
    return (a.plus | b.plus | c.plus) & (a.minus | b.minus | c.minus);
}

/* ---- two shared vertices, and one ---------------------------------------------------------------------- */

/* Lemmas 5 and 7. corners: those of the one triangle, then those of the other, the apex that is not shared first. */
static inline uint32_t sharing_edge_undecided(const vector_x8 corners[6]) {
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
    for (int k = 0; k < 3; k++) apart |= opposite_signs(turn_of(&face, k), turn_of(&other, k));
    return ALL_WIDTH & ~apart;
}

/* Computes the vectors that span the two cones. corners: those of the one triangle, then of the other, the shared
 * one first. */
static inline void cones_of(const vector_x8 corners[6], vector_x8 cones[2][2]) {
    for (int i = 0; i < 4; i++) from_to(corners[0], corners[i < 2 ? 1 + i : 2 + i], cones[i / 2][i % 2]);
}

/* Lemma 8 (a) and (b). */
static inline uint32_t sharing_vertex_undecided_by_cones(const vector_x8 corners[6]) {
    vector_x8 cones[2][2];
    normal_x8 ab, cd;
    cones_of(corners, cones);
    normal_of(cones[0][0], cones[0][1], &ab);
    sign_x8 abc = side_of(&ab, cones[1][0]), abd = side_of(&ab, cones[1][1]);
    if (same_sign(abc, abd) == ALL_WIDTH) return 0;
    normal_of(cones[1][0], cones[1][1], &cd);
    sign_x8 acd = side_of(&cd, cones[0][0]), bcd = side_of(&cd, cones[0][1]);
    uint32_t across = opposite_signs(abc, abd) & opposite_signs(acd, bcd) & opposite_signs(abd, acd);
    return ALL_WIDTH & ~(same_sign(abc, abd) | same_sign(acd, bcd) | across);
}

/* Lemma 8 (d). */
static inline uint32_t sharing_vertex_undecided_by_plane(const vector_x8 corners[6]) {
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
        sign_x8 side = sign_beyond(dot_x8(across, *e), f64w_all(0x1p-50) * dot_x8(size, size_e));
        apart &= i < 2 ? side.plus : side.minus;
    }
    return ALL_WIDTH & ~apart;
}

/* Lemma 8 (c). */
static inline uint32_t sharing_vertex_undecided_by_projection(const vector_x8 corners[6]) {
    vector_x8 cones[2][2];
    uint32_t apart = 0;
    cones_of(corners, cones);
    for (int k = 0; k < 3; k++) {
        sign_x8 between[2][2], own[2];
        for (int i = 0; i < 2; i++) {
            for (int j = 0; j < 2; j++) between[i][j] = turn_between(cones[0][i], cones[1][j], k);
            own[i] = turn_between(cones[i][0], cones[i][1], k);
        }
        /* The turn from a vector to the other one of its cone is own, with the other sign for the second vector. The
         * turn from it to a vector of the other cone is between, with the other sign for the second cone. */
        for (int i = 0; i < 2; i++) {
            uint32_t of_first = same_sign(between[i][0], between[i][1]),
                     of_second = same_sign(between[0][i], between[1][i]);
            uint32_t own_first =
                i == 0 ? opposite_signs(own[0], between[i][0]) : same_sign(own[0], between[i][0]);
            uint32_t own_second =
                i == 0 ? same_sign(own[1], between[0][i]) : opposite_signs(own[1], between[0][i]);
            apart |= (of_first & own_first) | (of_second & own_second);
        }
    }
    return ALL_WIDTH & ~apart;
}

/* ---- no shared vertex ---------------------------------------------------------------------------------- */

static inline f64w least_of(f64w a, f64w b, f64w c) {
    return f64w_min(f64w_min(a, b), c);
}

static inline f64w greatest_of(f64w a, f64w b, f64w c) {
    return f64w_max(f64w_max(a, b), c);
}

static inline uint32_t boxes_apart(const vector_x8 corners[6]) {
    const vector_x8 *a = corners, *b = corners + 3;
    uint32_t apart = 0;
    for (int k = 0; k < 3; k++) {
        apart |= f64w_below(greatest_of(a[0][k], a[1][k], a[2][k]), least_of(b[0][k], b[1][k], b[2][k]));
        apart |= f64w_below(greatest_of(b[0][k], b[1][k], b[2][k]), least_of(a[0][k], a[1][k], a[2][k]));
    }
    return apart;
}

/* Edge i leads from corner i to corner i + 1. */
static inline void edges_of(const vector_x8 corners[3], vector_x8 out[3]) {
    for (int i = 0; i < 3; i++) from_to(corners[i], corners[(i + 1) % 3], out[i]);
}

/* Finds on which side of the face's plane each corner lies. */
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

/* Lemma 9 (a) and (b). */
static inline uint32_t disjoint_undecided_by_planes(const vector_x8 corners[6]) {
    sign_x8 sides[3];
    uint32_t apart = boxes_apart(corners);
    if (apart == ALL_WIDTH) return 0;
    sides_of(corners, corners + 3, sides);
    apart |= same_sign_of_three(sides);
    if (apart == ALL_WIDTH) return 0;
    sides_of(corners + 3, corners, sides);
    return ALL_WIDTH & ~(apart | same_sign_of_three(sides));
}

/* Lemma 9 (c). *crossing: the lanes in which an edge certainly passes through the other face (e). */
static inline uint32_t disjoint_undecided_by_edges(const vector_x8 corners[6], uint32_t *crossing) {
    const vector_x8 *a = corners, *b = corners + 3;
    vector_x8 edges_a[3], edges_b[3];
    sign_x8 sides_a[3], sides_b[3], passes[3][3];
    uint32_t miss = ALL_WIDTH, hit = 0;
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
        miss &= same_sign(sides_a[i], sides_a[next]) | mixed_signs(passes[i][0], passes[i][1], passes[i][2]);
        miss &= same_sign(sides_b[i], sides_b[next]) | mixed_signs(passes[0][i], passes[1][i], passes[2][i]);
        const sign_x8 of_b[3] = {passes[0][i], passes[1][i], passes[2][i]};
        hit |= opposite_signs(sides_a[i], sides_a[next]) & same_sign_of_three(passes[i]);
        hit |= opposite_signs(sides_b[i], sides_b[next]) & same_sign_of_three(of_b);
    }
    *crossing = hit;
    return ALL_WIDTH & ~(miss | hit);
}

/* Returns the lanes in which the line of an edge of a has b strictly on one side, and the third corner of a on the
 * other. */
static inline uint32_t parted_by_edge_of(const vector_x8 a[3], const vector_x8 b[3], int axis) {
    vector_x8 edges[3];
    uint32_t apart = 0;
    edges_of(a, edges);
    sign_x8 own = turn_between(edges[0], edges[1], axis);
    for (int i = 0; i < 3; i++) {
        sign_x8 turns[3];
        for (int j = 0; j < 3; j++) {
            vector_x8 between;
            from_to(a[i], b[j], between);
            turns[j] = turn_between(edges[i], between, axis);
        }
        apart |= same_sign_of_three(turns) & opposite_signs(own, turns[0]);
    }
    return apart;
}

/* Lemma 9 (d). Lanes in which all corners are certainly off the plane are left: (c) has tried their edges already. */
static inline uint32_t disjoint_undecided_by_projection(const vector_x8 corners[6]) {
    sign_x8 sides[3];
    uint32_t apart = 0, flat = 0;
    sides_of(corners, corners + 3, sides);
    for (int i = 0; i < 3; i++) flat |= ALL_WIDTH & ~(sides[i].plus | sides[i].minus);
    for (int k = 0; k < 3 && (flat & ~apart) != 0; k++)
        apart |= parted_by_edge_of(corners, corners + 3, k) | parted_by_edge_of(corners + 3, corners, k);
    return ALL_WIDTH & ~(flat & apart);
}

/* ---- lists of pairs ------------------------------------------------------------------------------------ */

enum { PAIRS_AT_ONCE = 256, LIST_SIZE = PAIRS_AT_ONCE + LANES };

/* Pairs that share the same number of vertices. shared: bit i is set if corner i of a is shared, bit 3 + i if corner
 * i of b is. */
typedef struct pair_list {
    triangle_pair pairs[LIST_SIZE];
    uint8_t shared[LIST_SIZE];
    uint32_t count;
} pair_list;

/* For each set of shared corners: their number, and all corners in cyclic order, starting at the only corner that is
 * shared, or at the only one that is not. */
static const uint8_t sizes[8] = {0, 1, 1, 2, 1, 2, 2, 3};
static const uint8_t turned[8][3] = {{0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                     {2, 0, 1}, {1, 2, 0}, {0, 1, 2}, {0, 1, 2}};

/* Finds the shared corners of eight pairs, in the form of a pair_list. */
static inline void find_shared(const uint32_t (*triangles)[3], const triangle_pair *pairs,
                               int32_t shared[LANES]) {
    int32_t vertices[6][LANES];
    i32x8 a[3], b[3], sets = {0};
    for (int lane = 0; lane < LANES; lane++) {
        for (int i = 0; i < 3; i++) {
            vertices[i][lane] = (int32_t)triangles[pairs[lane].a][i];
            vertices[3 + i][lane] = (int32_t)triangles[pairs[lane].b][i];
        }
    }
    memcpy(a, vertices, sizeof a);
    memcpy(b, vertices + 3, sizeof b);
    /* A true comparison is -1. */
    for (int i = 2; i >= 0; i--)
        sets = sets + sets - (i32x8_equal(a[0], b[i]) | i32x8_equal(a[1], b[i]) | i32x8_equal(a[2], b[i]));
    for (int i = 2; i >= 0; i--)
        sets = sets + sets - (i32x8_equal(a[i], b[0]) | i32x8_equal(a[i], b[1]) | i32x8_equal(a[i], b[2]));
    memcpy(shared, &sets, sizeof sets);
}

/* Sorts at most PAIRS_AT_ONCE pairs into the lists by the number of shared vertices. */
static inline void sort_by_shared(const uint32_t (*triangles)[3], const triangle_pair *pairs, uint32_t count,
                                  pair_list lists[4]) {
    for (uint32_t first = 0; first < count; first += LANES) {
        triangle_pair eight[LANES];
        int32_t shared[LANES];
        uint32_t rest = count - first;
        for (uint32_t lane = 0; lane < LANES; lane++) eight[lane] = pairs[lane < rest ? first + lane : first];
        find_shared(triangles, eight, shared);
        for (uint32_t lane = 0; lane < LANES && lane < rest; lane++) {
            pair_list *list = &lists[sizes[shared[lane] & 7]];
            list->pairs[list->count] = eight[lane];
            list->shared[list->count++] = (uint8_t)shared[lane];
        }
    }
}

/* Loads the corners of the pairs from first on. The last vector is filled up with its first pair. loaded: the set of
 * corners that are needed. */
static inline void load_corners(const uint32_t (*triangles)[3], const double *positions,
                                const pair_list *list, uint32_t first, uint32_t loaded,
                                vector_x8 corners[6]) {
    uint32_t vertices[6][WIDTH];
    for (uint32_t lane = 0; lane < WIDTH; lane++) {
        uint32_t from = first + lane < list->count ? first + lane : first, shared = list->shared[from];
        const uint32_t *a = triangles[list->pairs[from].a], *b = triangles[list->pairs[from].b];
        for (int i = 0; i < 3; i++) {
            vertices[i][lane] = a[turned[shared & 7][i]];
            vertices[3 + i][lane] = b[turned[shared >> 3][i]];
        }
    }
    for (int i = 0; i < 6; i++) {
        if ((loaded >> i & 1) != 0) f64w_load_points(positions, vertices[i], corners[i]);
    }
}

typedef uint32_t test_lanes(const vector_x8 corners[6]);

/* Keeps the pairs that a test leaves undecided. */
static inline void keep_undecided(pair_list *list, const uint32_t (*triangles)[3], const double *positions,
                                  uint32_t loaded, test_lanes *test) {
    uint32_t kept = 0;
    for (uint32_t first = 0; first < list->count; first += WIDTH) {
        vector_x8 corners[6];
        load_corners(triangles, positions, list, first, loaded, corners);
        uint32_t rest = list->count - first, real = rest < WIDTH ? (1u << rest) - 1 : ALL_WIDTH;
        for (uint32_t open = test(corners) & real; open != 0; open &= open - 1) {
            uint32_t from = first + (uint32_t)__builtin_ctz(open);
            list->pairs[kept] = list->pairs[from];
            list->shared[kept++] = list->shared[from];
        }
    }
    list->count = kept;
}

/* The sets of corners that the tests of each list need. */
enum {
    DISJOINT_CORNERS = 63,
    SHARING_VERTEX_CORNERS = 1 + 2 + 4 + 16 + 32,
    SHARING_EDGE_CORNERS = 1 + 2 + 4 + 8
};

/* The same for pairs without a shared vertex and their edges. Appends those that certainly intersect to crossing, and returns
 * their number. */
static inline uint32_t keep_undecided_by_edges(pair_list *list, const uint32_t (*triangles)[3],
                                               const double *positions, triangle_pair *crossing) {
    uint32_t kept = 0, crossing_count = 0;
    for (uint32_t first = 0; first < list->count; first += WIDTH) {
        vector_x8 corners[6];
        load_corners(triangles, positions, list, first, DISJOINT_CORNERS, corners);
        uint32_t rest = list->count - first, real = rest < WIDTH ? (1u << rest) - 1 : ALL_WIDTH, hit;
        uint32_t open = disjoint_undecided_by_edges(corners, &hit) & real;
        for (hit &= real; hit != 0; hit &= hit - 1)
            crossing[crossing_count++] = list->pairs[first + (uint32_t)__builtin_ctz(hit)];
        for (; open != 0; open &= open - 1) {
            uint32_t from = first + (uint32_t)__builtin_ctz(open);
            list->pairs[kept] = list->pairs[from];
            list->shared[kept++] = list->shared[from];
        }
    }
    list->count = kept;
    return crossing_count;
}

static uint32_t reject_disjoint(const uint32_t (*triangles)[3], const double *positions, triangle_pair *pairs,
                                uint32_t count, bool keep_duplicates, triangle_pair *crossing,
                                uint32_t *crossing_count) {
    pair_list lists[4];
    uint32_t kept = 0, hits = 0;
    int most_shared = keep_duplicates ? 3 : 2;
    for (uint32_t begin = 0; begin < count; begin += PAIRS_AT_ONCE) {
        for (int i = 0; i < 4; i++) lists[i].count = 0;
        sort_by_shared(triangles, pairs + begin,
                       count - begin < PAIRS_AT_ONCE ? count - begin : PAIRS_AT_ONCE, lists);
        keep_undecided(&lists[0], triangles, positions, DISJOINT_CORNERS, disjoint_undecided_by_planes);
        hits += keep_undecided_by_edges(&lists[0], triangles, positions, crossing + hits);
        keep_undecided(&lists[0], triangles, positions, DISJOINT_CORNERS, disjoint_undecided_by_projection);
        keep_undecided(&lists[1], triangles, positions, SHARING_VERTEX_CORNERS,
                       sharing_vertex_undecided_by_cones);
        keep_undecided(&lists[1], triangles, positions, SHARING_VERTEX_CORNERS,
                       sharing_vertex_undecided_by_plane);
        keep_undecided(&lists[1], triangles, positions, SHARING_VERTEX_CORNERS,
                       sharing_vertex_undecided_by_projection);
        keep_undecided(&lists[2], triangles, positions, SHARING_EDGE_CORNERS, sharing_edge_undecided);
        for (int i = 0; i <= most_shared; i++) {
            memcpy(pairs + kept, lists[i].pairs, lists[i].count * sizeof *pairs);
            kept += lists[i].count;
        }
    }
    *crossing_count = hits;
    return kept;
}

/* ---- single triangles ---------------------------------------------------------------------------------- */

/* Writes eight masks of lanes, the first one to bit 0 of every lane's byte. */
static inline void bytes_of_masks(const uint32_t masks[8], uint8_t bytes[8]) {
    uint64_t all = 0;
    for (int bit = 0; bit < 8; bit++) {
        /* Byte i keeps bit i of the mask alone, which is then moved to bit 0. */
        uint64_t own = masks[bit] * UINT64_C(0x0101010101010101) & UINT64_C(0x8040201008040201);
        all |= ((own + UINT64_C(0x7f7f7f7f7f7f7f7f)) >> 7 & UINT64_C(0x0101010101010101)) << bit;
    }
    for (int lane = 0; lane < 8; lane++) bytes[lane] = (uint8_t)(all >> (8 * lane));
}

static inline void find_normal_signs(const vector_x8 corners[3], uint8_t out[8]) {
    uint32_t masks[8] = {0};
    vector_x8 u, v;
    normal_x8 normal;
    from_to(corners[0], corners[1], u);
    from_to(corners[0], corners[2], v);
    normal_of(u, v, &normal);
    for (int k = 0; k < 3; k++) {
        sign_x8 sign = turn_of(&normal, k);
        masks[2 * k] = sign.plus;
        masks[2 * k + 1] = sign.minus;
    }
    bytes_of_masks(masks, out);
}

static inline void find_rises(const vector_x8 corners[3], uint8_t out[8]) {
    uint32_t masks[8] = {0};
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3, last = (i + 2) % 3;
        for (int y = 0; y < 2; y++)
            masks[RISES_ALONG_Y * y + i] = f64w_below(corners[next][2 - y], corners[i][2 - y]) &
                                           ~f64w_below(corners[last][2 - y], corners[i][2 - y]);
    }
    bytes_of_masks(masks, out);
}

static void sign_normals(const uint32_t (*triangles)[3], const double *positions, const uint32_t *list,
                         uint32_t count, uint8_t *normals, uint8_t *rises) {
    for (uint32_t first = 0; first < count; first += WIDTH) {
        uint32_t rest = count - first;
        uint32_t vertices[3][WIDTH];
        vector_x8 corners[3];
        uint8_t signs[8], ups[8];
        for (uint32_t lane = 0; lane < WIDTH; lane++) {
            const uint32_t *triangle = triangles[list[lane < rest ? first + lane : first]];
            for (int i = 0; i < 3; i++) vertices[i][lane] = triangle[i];
        }
        for (int i = 0; i < 3; i++) f64w_load_points(positions, vertices[i], corners[i]);
        find_normal_signs((const vector_x8 *)corners, signs);
        find_rises((const vector_x8 *)corners, ups);
        for (uint32_t lane = 0; lane < WIDTH && lane < rest; lane++) {
            normals[list[first + lane]] = signs[lane];
            rises[list[first + lane]] = ups[lane];
        }
    }
}

const intersection_kernels SIMD_NAME(intersection_kernels) = {reject_disjoint, sign_normals};
