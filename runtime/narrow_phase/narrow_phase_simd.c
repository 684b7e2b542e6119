/* The kernels of the narrow phase, one table per instruction set: which pairs of features eight pairs of
 * triangles test. */
#include "runtime/narrow_phase/narrow_phase_kernels.h"
#include "src/core/simd.h"

/* ---- representatives ---------------------------------------------------------------------------------- */

/* Finds which features each of many triangle pairs represents, and which ones have adjacent representatives.
 * Takes eight pairs at a time: branches would cost more than they save. */

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

static void SIMD_NAME(represent)(const cscd_mesh *mesh, const representatives *r, const triangle_pair *pairs,
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

/* ---- volumes of features ------------------------------------------------------------------------------ */

/* Keeps those of two triangles' fifteen pairs of features that may touch, before any of them is loaded in double.
 *
 * When all points of one feature lie beyond all points of the other along one direction at both ends of the
 * interval, the two stay apart throughout, since their points move linearly. The directions are those of
 * 14-DOPs. A lane is a pair of triangles, so that all fifteen are decided for eight at once.
 *
 * With u = 2^-24, and M the sum of both trees' reaches and of what lies between the trees, a coordinate of a
 * record is off by u M at most, moved into the other tree's frame by 3 u M; a gap is a difference of two
 * such, rounded once more: off by less than 6 u M. A sum of three coordinates carries their errors and two
 * roundings of numbers below 3 M, 9 u M + 6 u M, and a gap of such sums less than 36 u M. Gaps count from
 * 8 u M and 48 u M on. */

enum { FEATURE_COUNT = 15 };

/* The corners of triangles a, then those of b, along one direction at both ends. */
typedef f32x8 coordinates[2][6];

/* Eight pairs of triangles. */
typedef struct pairs_x8 {
    f32x8 points[6][8]; /* corners of a, then of b: x y z . at the start, x y z . at the end */
    uint32_t vertices[6][LANES];
    float gap[LANES], wide[LANES]; /* beyond rounding and distance, along axes and diagonals */
} pairs_x8;

typedef struct range {
    f32x8 low, high;
} range;

static inline range join_ranges(range a, range b) {
    return (range){f32x8_min(a.low, b.low), f32x8_max(a.high, b.high)};
}

/* Two features along one direction, at both ends or, the same, at the only moment there is. */
typedef struct range_pair {
    range a[2], b[2];
} range_pair;

/* The distance by which a and b stay apart on the same side at all ends; negative where they do not. */
static inline f32x8 gap_between(const range_pair *p, int ends) {
    f32x8 before = p->b[0].low - p->a[0].high, behind = p->a[0].low - p->b[0].high;
    if (ends == 2) {
        before = f32x8_min(before, p->b[1].low - p->a[1].high);
        behind = f32x8_min(behind, p->a[1].low - p->b[1].high);
    }
    return f32x8_max(before, behind);
}

/* Vertices, edges i to i + 1, faces of a and b. */
typedef struct ranges {
    range vertices[2][3], edges[2][3], faces[2];
} ranges;

static inline void ranges_of(const f32x8 points[6], ranges *out) {
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 3; i++) out->vertices[t][i] = (range){points[3 * t + i], points[3 * t + i]};
        for (int i = 0; i < 3; i++)
            out->edges[t][i] = join_ranges(out->vertices[t][i], out->vertices[t][(i + 1) % 3]);
        out->faces[t] = join_ranges(out->edges[t][0], out->vertices[t][2]);
    }
}

/* Widens each gap to that along one more direction, where this is larger. */
static inline void widen_gaps(const coordinates at, int ends, f32x8 gaps[FEATURE_COUNT]) {
    ranges r[2];
    for (int e = 0; e < ends; e++) ranges_of(at[e], &r[e]);
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 3; i++) {
            range_pair pair;
            for (int e = 0; e < ends; e++) {
                pair.a[e] = r[e].vertices[t][i];
                pair.b[e] = r[e].faces[1 - t];
            }
            gaps[3 * t + i] = f32x8_max(gaps[3 * t + i], gap_between(&pair, ends));
        }
    }
    for (int i = 0; i < 9; i++) {
        range_pair pair;
        for (int e = 0; e < ends; e++) {
            pair.a[e] = r[e].edges[0][i / 3];
            pair.b[e] = r[e].edges[1][i % 3];
        }
        gaps[FEATURE_EDGES + i] = f32x8_max(gaps[FEATURE_EDGES + i], gap_between(&pair, ends));
    }
}

/* Keeps the features whose gaps do not exceed `least`. */
static inline i32x8 keep_near(const f32x8 gaps[FEATURE_COUNT], f32x8 least, i32x8 features) {
    for (int i = 0; i < FEATURE_COUNT; i++) features &= ~(f32x8_above(gaps[i], least) & i32x8_all(1 << i));
    return features;
}

static inline i32x8 near_along_axes(const pairs_x8 *o, int ends, i32x8 features) {
    f32x8 gaps[FEATURE_COUNT];
    for (int i = 0; i < FEATURE_COUNT; i++) gaps[i] = f32x8_all(-1.0f);
    for (int k = 0; k < 3; k++) {
        coordinates at;
        for (int i = 0; i < 6 * ends; i++) at[i / 6][i % 6] = o->points[i % 6][i / 6 * 4 + k];
        widen_gaps((const f32x8(*)[6])at, ends, gaps);
    }
    return keep_near(gaps, f32x8_load(o->gap), features);
}

/* Along direction BOX_AXES + k of kdop_axes. */
static inline f32x8 along_diagonal(const f32x8 p[3], int k) {
    return k == 0   ? p[0] + p[1] + p[2]
           : k == 1 ? p[0] + p[1] - p[2]
           : k == 2 ? p[0] - p[1] + p[2]
                    : p[1] - p[0] + p[2];
}

static inline i32x8 near_along_diagonals(const pairs_x8 *o, int ends, i32x8 features) {
    f32x8 gaps[FEATURE_COUNT];
    for (int i = 0; i < FEATURE_COUNT; i++) gaps[i] = f32x8_all(-1.0f);
    for (int k = 0; k < KDOP_AXES - BOX_AXES; k++) {
        coordinates at;
        for (int i = 0; i < 6 * ends; i++) at[i / 6][i % 6] = along_diagonal(&o->points[i % 6][i / 6 * 4], k);
        widen_gaps((const f32x8(*)[6])at, ends, gaps);
    }
    return keep_near(gaps, f32x8_load(o->wide), features);
}

/* Pairs of features that share a vertex. */
static inline i32x8 sharing_vertex(const pairs_x8 *o) {
    i32x8 corners[6], same[3][3], features = {0};
    for (int i = 0; i < 6; i++) corners[i] = i32x8_load(o->vertices[i]);
    for (int i = 0; i < 9; i++) same[i / 3][i % 3] = i32x8_equal(corners[i / 3], corners[3 + i % 3]);
    for (int i = 0; i < 3; i++) {
        i32x8 of_a = same[i][0] | same[i][1] | same[i][2], of_b = same[0][i] | same[1][i] | same[2][i];
        features |= (of_a & i32x8_all(1 << i)) | (of_b & i32x8_all(1 << (FEATURE_VERTEX_B + i)));
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, j1 = (j + 1) % 3;
            i32x8 any = same[i][j] | same[i][j1] | same[i1][j] | same[i1][j1];
            features |= any & i32x8_all(1 << (FEATURE_EDGES + 3 * i + j));
        }
    }
    return features;
}

/* Two trees, and the margins that all pairs of their triangles share. */
typedef struct tree_pair {
    uint32_t a, b;
    f32x8 between;         /* is added to a record of b */
    double size, distance; /* by which the following are rounded and wide */
    float gap, wide;       /* as in pairs_x8 */
} tree_pair;

static double tree_distance(const swept_interval *interval, const bvh_tree *p, const bvh_tree *q) {
    double distance = interval->limit.distance;
    if (interval->thick) {
        distance = object_separation(interval, p->object, q->object).distance;
    }
    return distance + interval->beyond;
}

static float gap_within(const swept_interval *interval, const tree_pair *trees, double distance) {
    const double d = distance * interval->bvh->scale * (1.0 + 0x1p-20);
    return (float)(trees->size * 0x1p-21 + d) * (1.0f + 0x1p-20f);
}

static float wide_within(const swept_interval *interval, const tree_pair *trees, double distance) {
    const double d = distance * interval->bvh->scale * (1.0 + 0x1p-20);
    return (float)(trees->size * 0x1.8p-19 + 1.7320508076 * d) * (1.0f + 0x1p-20f);
}

static void relate_parts(const swept_interval *interval, uint32_t a, uint32_t b, tree_pair *out) {
    const bvh *hierarchy = interval->bvh;
    const bvh_tree *p = &hierarchy->trees[a], *q = &hierarchy->trees[b];
    float between[LANES] = {0.0f};
    double size = (double)p->reach + (double)q->reach;
    for (int i = 0; i < 6 && a != b; i++) {
        double from = p->origin[i / 3][i % 3] * hierarchy->scale,
               to = q->origin[i / 3][i % 3] * hierarchy->scale;
        between[i / 3 * 4 + i % 3] =
            (float)((q->origin[i / 3][i % 3] - p->origin[i / 3][i % 3]) * hierarchy->scale);
        size += __builtin_fabs(to - from) + 0x1p-28 * (__builtin_fabs(from) + __builtin_fabs(to));
    }
    out->a = a;
    out->b = b;
    out->between = f32x8_load(between);
    out->size = size;
    out->distance = tree_distance(interval, p, q);
    out->gap = gap_within(interval, out, out->distance);
    out->wide = wide_within(interval, out, out->distance);
}

/* How far the vertices of a triangle may go. */
static double way_of_slot(const swept_interval *interval, uint32_t slot) {
    const bvh *hierarchy = interval->bvh;
    const bvh_leaf *leaf = &hierarchy->leaves[slot / LANES];
    double way = 0.0;
    for (int i = 0; i < 3; i++)
        way = larger_way(way,
                         interval->motion->ways[hierarchy->record_vertices[leaf->corners[i][slot % LANES]]]);
    return way;
}

/* Lowers what two triangles must stay apart by to what their motion may do. */
static void lower_to_ways(const swept_interval *interval, triangle_pair pair, uint32_t lane,
                          const tree_pair *trees, pairs_x8 *out) {
    const double way = way_of_slot(interval, pair.a) + way_of_slot(interval, pair.b),
                 distance = distance_on_ways(interval->motion, way);
    if (distance >= trees->distance) return;
    out->gap[lane] = gap_within(interval, trees, distance);
    out->wide[lane] = wide_within(interval, trees, distance);
}

/* The places of the last pair are filled up with itself. */
static inline void load_pairs(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                              tree_pair *trees, pairs_x8 *out) {
    const bvh *hierarchy = interval->bvh;
    f32x8 rows[6][LANES];
    for (uint32_t lane = 0; lane < LANES; lane++) {
        triangle_pair pair = pairs[lane < count ? lane : count - 1];
        const bvh_leaf *a = &hierarchy->leaves[pair.a / LANES], *b = &hierarchy->leaves[pair.b / LANES];
        uint32_t tree_a = hierarchy->leaf_trees[pair.a / LANES],
                 tree_b = hierarchy->leaf_trees[pair.b / LANES];
        if (tree_a != trees->a || tree_b != trees->b) relate_parts(interval, tree_a, tree_b, trees);
        for (int i = 0; i < 3; i++) {
            uint32_t record_a = a->corners[i][pair.a % LANES], record_b = b->corners[i][pair.b % LANES];
            rows[i][lane] = f32x8_load(hierarchy->records[record_a]);
            rows[3 + i][lane] = f32x8_load(hierarchy->records[record_b]) + trees->between;
            out->vertices[i][lane] = tree_a == tree_b ? record_a : hierarchy->record_vertices[record_a];
            out->vertices[3 + i][lane] = tree_a == tree_b ? record_b : hierarchy->record_vertices[record_b];
        }
        out->gap[lane] = trees->gap;
        out->wide[lane] = trees->wide;
        if (interval->motion != NULL) lower_to_ways(interval, pair, lane, trees, out);
    }
    for (int i = 0; i < 6; i++) {
        f32x8_transpose(rows[i]);
        for (int k = 0; k < 8; k++) out->points[i][k] = rows[i][k];
    }
}

/* None in the lanes from `lanes` on. */
static inline i32x8 load_features(const uint16_t *features, uint32_t lanes) {
    uint32_t all[LANES] = {0};
    for (uint32_t i = 0; i < lanes; i++) all[i] = features[i];
    return i32x8_load(all);
}

static inline bool any_feature(i32x8 features) {
    return i32x8_negative(-features) != 0;
}

static inline void filter_pairs(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                                bool apart, int ends, uint16_t *features) {
    tree_pair trees = {.a = UINT32_MAX};
    for (uint32_t p = 0; p < count; p += LANES) {
        uint32_t lanes = count - p < LANES ? count - p : LANES;
        pairs_x8 o;
        load_pairs(interval, pairs + p, lanes, &trees, &o);
        i32x8 kept = load_features(features + p, lanes);
        if (!apart) kept &= ~sharing_vertex(&o);
        kept = near_along_axes(&o, ends, kept);
        if (any_feature(kept)) kept = near_along_diagonals(&o, ends, kept);
        for (uint32_t i = 0; i < lanes; i++) features[p + i] = (uint16_t)kept[i];
    }
}

/* Both ends are one moment where their positions are the same array. */
static void SIMD_NAME(feature_filter)(const swept_interval *interval, const triangle_pair *pairs,
                                      uint32_t count, bool apart, uint16_t *features) {
    if (interval->x0 == interval->x1)
        filter_pairs(interval, pairs, count, apart, 1, features);
    else
        filter_pairs(interval, pairs, count, apart, 2, features);
}

/* ---- the table ---------------------------------------------------------------------------------------- */

const narrow_phase_kernels SIMD_NAME(narrow_phase_kernels) = {
    .feature_filter = SIMD_NAME(feature_filter),
    .represent = SIMD_NAME(represent),
};
