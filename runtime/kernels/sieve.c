/* Of two triangles' fifteen pairs of features, those that may touch: before any of them is loaded in double.
 *
 * Two features of which all points of one lie beyond all points of the other, along one direction and at both
 * ends of the interval, stay apart throughout, since their points move linearly. The directions are those of
 * 14-DOPs; a record holds both ends, so one comparison takes three directions at both.
 *
 * With u = 2^-24, and M the sum of both parts' reaches and of what lies between the parts, a coordinate of a
 * record is off by u M at most, moved into the other part's frame by 3 u M; a gap is a difference of two
 * such, rounded once more: off by less than 6 u M. A sum of three coordinates carries their errors and two
 * roundings of numbers below 3 M, 9 u M + 6 u M, and a gap of such sums less than 36 u M. Gaps count from
 * 8 u M and 48 u M on. */
#include "runtime/kernels/this_level.h"

/* One direction's bit for the start, the same one's for the end four lanes on. */
static inline bool at_both_ends(uint32_t lanes) {
    return (lanes & (lanes >> 4) & 15) != 0;
}

typedef struct extent {
    f32x8 low, high;
} extent;

static inline extent join(extent a, extent b) {
    return (extent){f32x8_min(a.low, b.low), f32x8_max(a.high, b.high)};
}

static inline bool stay_apart(extent a, extent b, f32x8 gap) {
    return at_both_ends(f32x8_below(gap, a.low - b.high)) || at_both_ends(f32x8_below(gap, b.low - a.high));
}

/* Vertices, edges i to i + 1, faces of both. */
typedef struct extents {
    extent vertices[2][3], edges[2][3], faces[2];
} extents;

static inline void extents_of(f32x8 (*rows)[3], extents *out) {
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 3; i++) out->vertices[t][i] = (extent){rows[t][i], rows[t][i]};
        for (int i = 0; i < 3; i++)
            out->edges[t][i] = join(out->vertices[t][i], out->vertices[t][(i + 1) % 3]);
        out->faces[t] = join(out->edges[t][0], out->vertices[t][2]);
    }
}

static inline uint32_t keep_near(const extents *e, f32x8 gap, uint32_t features) {
    uint32_t kept = features;
    for (uint32_t rest = features; rest != 0; rest &= rest - 1) {
        int bit = __builtin_ctz(rest), i = (bit - FEATURE_EDGES) / 3, j = (bit - FEATURE_EDGES) % 3;
        bool apart = bit >= FEATURE_EDGES ? stay_apart(e->edges[0][i], e->edges[1][j], gap)
                     : bit >= FEATURE_VERTEX_B
                         ? stay_apart(e->vertices[1][bit - FEATURE_VERTEX_B], e->faces[0], gap)
                         : stay_apart(e->vertices[0][bit], e->faces[1], gap);
        kept ^= (uint32_t)apart << bit;
    }
    return kept;
}

/* x+y+z, x+y-z, x-y+z, -x+y+z at both ends. */
static inline f32x8 diagonals(f32x8 row) {
    const i32x8 second = {0, 0, INT32_MIN, 0, 0, 0, INT32_MIN, 0};
    const i32x8 third = {0, INT32_MIN, 0, INT32_MIN, 0, INT32_MIN, 0, INT32_MIN};
    f32x8 a = __builtin_shufflevector(row, row, 0, 0, 0, 1, 4, 4, 4, 5);
    f32x8 b = __builtin_shufflevector(row, row, 1, 1, 1, 2, 5, 5, 5, 6);
    f32x8 c = __builtin_shufflevector(row, row, 2, 2, 2, 0, 6, 6, 6, 4);
    return (a + (f32x8)((i32x8)b ^ second)) + (f32x8)((i32x8)c ^ third);
}

/* Of which features of a and b a vertex is the same one; shared: bit 3 i + j: vertex i of a is vertex j of b.
 */
static uint32_t sharing(uint32_t shared) {
    uint32_t features = 0;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t row = shared >> (3 * i) & 7, next = shared >> (3 * ((i + 1) % 3)) & 7;
        uint32_t both = row | next;
        features |= (uint32_t)(row != 0) << i;
        for (uint32_t j = 0; j < 3; j++) {
            features |= (row >> j & 1) << (FEATURE_VERTEX_B + j);
            features |= (both >> j & 1) << (FEATURE_EDGES + 3 * i + j) |
                        (both >> j & 1) << (FEATURE_EDGES + 3 * i + (j + 2) % 3);
        }
    }
    return features;
}

static inline uint32_t shared_vertices(const uint32_t a[3], const uint32_t b[3]) {
    uint32_t shared = 0;
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t j = 0; j < 3; j++) shared |= (uint32_t)(a[i] == b[j]) << (3 * i + j);
    }
    return shared;
}

/* What is known of two parts, whichever. */
typedef struct part_pair {
    uint32_t a, b;
    f32x8 between;   /* what is to be added to a record of b */
    f32x8 gap, wide; /* beyond rounding and distance, along axes and diagonals */
} part_pair;

static void relate(const forest *f, uint32_t a, uint32_t b, double distance, part_pair *out) {
    const forest_part *p = &f->parts[a], *q = &f->parts[b];
    float between[LANES] = {0.0f};
    double size = (double)p->reach + (double)q->reach, d = distance * f->scale * (1.0 + 0x1p-20);
    for (int i = 0; i < 6 && a != b; i++) {
        double from = p->origin[i / 3][i % 3] * f->scale, to = q->origin[i / 3][i % 3] * f->scale;
        between[i / 3 * 4 + i % 3] = (float)((q->origin[i / 3][i % 3] - p->origin[i / 3][i % 3]) * f->scale);
        size += __builtin_fabs(to - from) + 0x1p-28 * (__builtin_fabs(from) + __builtin_fabs(to));
    }
    out->a = a;
    out->b = b;
    out->between = f32x8_load(between);
    out->gap = f32x8_all((float)(size * 0x1p-21 + d) * (1.0f + 0x1p-20f));
    out->wide = f32x8_all((float)(size * 0x1.8p-19 + 1.7320508076 * d) * (1.0f + 0x1p-20f));
}

static inline void load_rows(const forest *f, triangle_pair pair, const part_pair *parts, f32x8 rows[2][3],
                             uint32_t records[2][3]) {
    const forest_leaf *a = &f->leaves[pair.a / LANES], *b = &f->leaves[pair.b / LANES];
    for (int i = 0; i < 3; i++) {
        records[0][i] = a->corners[i][pair.a % LANES];
        records[1][i] = b->corners[i][pair.b % LANES];
        rows[0][i] = f32x8_load(f->records[records[0][i]]);
        rows[1][i] = f32x8_load(f->records[records[1][i]]) + parts->between;
    }
}

void SIMD_NAME(sieve)(const forest *f, const triangle_pair *pairs, uint32_t count, double distance,
                      const uint16_t *wanted, uint16_t *features) {
    part_pair parts = {.a = UINT32_MAX};
    for (uint32_t p = 0; p < count; p++) {
        uint32_t a = f->leaf_parts[pairs[p].a / LANES], b = f->leaf_parts[pairs[p].b / LANES];
        if (a != parts.a || b != parts.b) relate(f, a, b, distance, &parts);
        f32x8 rows[2][3];
        uint32_t records[2][3], kept = wanted[p];
        extents e;
        load_rows(f, pairs[p], &parts, rows, records);
        if (a != b) {
            for (int i = 0; i < 6; i++) records[i / 3][i % 3] = f->record_vertices[records[i / 3][i % 3]];
        }
        uint32_t shared = shared_vertices(records[0], records[1]);
        if (shared != 0) kept &= ~sharing(shared);
        extents_of(rows, &e);
        kept = keep_near(&e, parts.gap, kept);
        if (kept != 0) {
            for (int i = 0; i < 6; i++) rows[i / 3][i % 3] = diagonals(rows[i / 3][i % 3]);
            extents_of(rows, &e);
            kept = keep_near(&e, parts.wide, kept);
        }
        features[p] = (uint16_t)kept;
    }
}
