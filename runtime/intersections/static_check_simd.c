/* Rejects pairs of triangles that certainly do not intersect, and finds the signs of normals. Pairs are
 * sorted by the number of vertices that they share, and tested as many at a time as a register of doubles holds. */
#include "runtime/intersections/intersection_kernels.h"
#include "runtime/intersections/triangle_intersection_simd.h"

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

/* ---- single triangles -------------------------------------------------------------------------------- */

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
