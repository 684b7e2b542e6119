/* Finds which features each of many triangle pairs represents, and which ones have adjacent representatives.
 * Takes eight pairs at a time: branches would cost more than they save. */
#include "runtime/narrow_phase/narrow_phase_kernels_simd.h"

/* Triangles a ([0]) and b ([1]) of eight pairs. Edge i joins corners i and i + 1. */
typedef struct represented_x8 {
    uint32_t corners[2][3][LANES];
    uint32_t others[2][3][2][LANES]; /* the other two corners of the representative of each corner */
    uint32_t opposite[2][3][LANES];  /* the corner opposite each edge in the edge's representative */
    uint32_t represented[LANES];     /* features that the pair represents */
} represented_x8;

/* One vertex, or one mask of all bits, for each of three corners or edges. */
typedef i32x8 lane_set[3];

static inline void load_triangle(const cscd_mesh *mesh, const representatives *r, uint32_t triangle, int t,
                                 uint32_t lane, represented_x8 *out) {
    for (int i = 0; i < 3; i++) {
        uint32_t vertex = mesh->triangles[triangle][i];
        out->corners[t][i][lane] = vertex;
        out->others[t][i][0][lane] = r->others[vertex][0];
        out->others[t][i][1][lane] = r->others[vertex][1];
        out->opposite[t][i][lane] = r->opposite[mesh->triangle_edges[triangle][i]];
    }
}

static inline i32x8 is_corner(const lane_set corners, i32x8 vertex) {
    return i32x8_equal(corners[0], vertex) | i32x8_equal(corners[1], vertex) |
           i32x8_equal(corners[2], vertex);
}

/* The corners of t whose representatives share a vertex with the other triangle. */
static inline i32x8 adjacent_corners(const represented_x8 *o, int t, int first_bit) {
    i32x8 features = {0};
    lane_set face;
    for (int i = 0; i < 3; i++) face[i] = i32x8_load(o->corners[1 - t][i]);
    for (int i = 0; i < 3; i++) {
        i32x8 adjacent = is_corner((const i32x8 *)face, i32x8_load(o->others[t][i][0])) |
                         is_corner((const i32x8 *)face, i32x8_load(o->others[t][i][1]));
        features |= adjacent & i32x8_all(1 << (first_bit + i));
    }
    return features;
}

/* Pairs of edges whose representatives share a vertex, if the edges share none. */
static inline i32x8 adjacent_edges(const represented_x8 *o) {
    i32x8 features = {0};
    lane_set corners[2], over[2];
    lane_set at[2][3]; /* at[t][i]: which corners of t are opposite edge i of the other triangle */
    for (int i = 0; i < 6; i++) {
        corners[i / 3][i % 3] = i32x8_load(o->corners[i / 3][i % 3]);
        over[i / 3][i % 3] = i32x8_load(o->opposite[i / 3][i % 3]);
    }
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 9; i++) at[t][i / 3][i % 3] = i32x8_equal(corners[t][i % 3], over[1 - t][i / 3]);
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            i32x8 adjacent = i32x8_equal(over[0][i], over[1][j]) | at[1][i][j] | at[1][i][(j + 1) % 3] |
                             at[0][j][i] | at[0][j][(i + 1) % 3];
            features |= adjacent & i32x8_all(1 << (FEATURE_EDGES + 3 * i + j));
        }
    }
    return features;
}

/* Bits 0, 1 and 2 go to places 0, 3 and 6. */
static inline uint32_t spread_by_three(uint32_t edges) {
    return (edges & 1u) | (edges & 2u) << 2 | (edges & 4u) << 4;
}

void SIMD_NAME(represent)(const cscd_mesh *mesh, const representatives *r, const triangle_pair *pairs,
                          uint32_t count, uint16_t *features, uint16_t *undecided) {
    for (uint32_t p = 0; p < count; p += LANES) {
        represented_x8 o;
        uint32_t lanes = count - p < LANES ? count - p : LANES;
        for (uint32_t i = 0; i < LANES; i++) {
            triangle_pair pair = pairs[i < lanes ? p + i : p];
            uint32_t a = represented_features(r, pair.a), b = represented_features(r, pair.b);
            load_triangle(mesh, r, pair.a, 0, i, &o);
            load_triangle(mesh, r, pair.b, 1, i, &o);
            o.represented[i] = (a & 7u) | (b & 7u) << FEATURE_VERTEX_B |
                               (spread_by_three(a >> 3) * (b >> 3)) << FEATURE_EDGES;
        }
        i32x8 adjacent =
            adjacent_corners(&o, 0, 0) | adjacent_corners(&o, 1, FEATURE_VERTEX_B) | adjacent_edges(&o);
        for (uint32_t i = 0; i < lanes; i++) {
            uint32_t all = features[p + i], own = all & o.represented[i];
            features[p + i] = (uint16_t)own;
            undecided[p + i] = (uint16_t)(all & ~own & (uint32_t)adjacent[i]);
        }
    }
}
