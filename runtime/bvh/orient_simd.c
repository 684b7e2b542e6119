/* Orientations of triangles over an interval, eight at a time.
 *
 * s(t) = c . (a x b), with a = p1 - p0, b = p2 - p0 and c = p0 - d moving linearly, is a cubic in t. Its Bernstein
 * coefficients, the middle two times 3, are compared with a bound on their error.
 *
 * Let u = 2^-24, M the tree's reach and M' = M + |d|.
 * - A coordinate of a record is off by at most u M (1 + 2^-20). d is exact by definition.
 * - So components of a and b are off by 2.01 u M + u |a| and 2.01 u M + u |b|, those of c by 1.01 u M + u |c|.
 * - Let A, B and C be the largest magnitudes of computed components over both ends. Then A, B <= 2 M and C <= M'.
 * - A coefficient (times 3 for the middle ones, which are sums of three determinants) is at most a sum of 18 products,
 *   each at most A B C.
 * - Inputs off by u (2.01 M + A) and so on change a product by at most
 *   u (2.01 M B C + 2.01 M A C + 1.01 M A B + 3 A B C) and terms of u^2, less than one in 2^20 of that.
 * - The two multiplications of a product and at most 6 additions add 8.01 u A B C.
 * - So the errors of 18 products stay below
 *   u (36.2 M (A + B) C + 18.2 M A B + 198.2 A B C) <= u M' (37 (A + B) C + 217 A B).
 * The code takes 2^-18 M' (C (A + B) + 4 A B) = u M' (64 (A + B) C + 256 A B), which leaves room. Nothing of this
 * underflows by more than the 2^-100 that is added. */
#include "runtime/bvh/bvh_simd.h"

static f32x8 largest_component(f32x8 (*v)[3]) {
    f32x8 largest = f32x8_abs(v[0][0]);
    for (int i = 1; i < 6; i++) largest = f32x8_max(largest, f32x8_abs(v[i / 3][i % 3]));
    return largest;
}

static void cross_f32x8(const f32x8 a[3], const f32x8 b[3], f32x8 out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static f32x8 dot_f32x8(const f32x8 a[3], const f32x8 b[3]) {
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

/* ---- signs that last --------------------------------------------------------------------------------- */

/* No less than the length of v, and never 0. */
static f32x8 length_above(const f32x8 v[3]) {
    f32x8 sum = dot_f32x8(v, v) * f32x8_all(1.0f + 0x1p-20f) + f32x8_all(0x1p-100f);
    return f32x8_sqrt(sum) * f32x8_all(1.0f + 0x1p-20f);
}

/* Returns the E up to which a and b may change while c changes by up to R, so that s = c . (a x b) changes by less than its
 * magnitude (the skin in bvh.h); below 0 where R alone is too much. n = a x b changes by at most E (L + E), with
 * L = |a| + |b|, so s by at most |n| R + E (L + E) (|c| + R). This is |s| without the bound on its error where
 * E (L + E) = K, which is (|s| - bound - |n| R) / (|c| + R), and E = 2 K / (L + sqrt(L^2 + 4 K)). */
static f32x8 lasting_stretch(const f32x8 a[3], const f32x8 b[3], const f32x8 c[3], const f32x8 normal[3],
                             f32x8 margin, float distance) {
    f32x8 r = f32x8_all(distance), sum = length_above(a) + length_above(b), none = f32x8_all(0.0f);
    f32x8 k = (margin - length_above(normal) * r * f32x8_all(1.0f + 0x1p-20f)) / (length_above(c) + r);
    f32x8 root = f32x8_sqrt(sum * sum + f32x8_all(4.0f) * f32x8_max(k, none));
    return (k + k) / (sum + root) * f32x8_all(1.0f - 0x1p-18f);
}

/* ---- leaves -------------------------------------------------------------------------------------------- */

/* Writes which lanes are PLUS and MINUS; corners[i][end][axis]. lasting: see orientation_query, and then the stretches that
 * signs last for are written, too; NULL: for the interval. */
static inline void orient_lanes(const bvh_tree *tree, f32x8 (*corners)[2][3],
                                const orientation_lasting *lasting, uint32_t *plus, uint32_t *minus,
                                f32x8 *stretches) {
    f32x8 a[2][3], b[2][3], c[2][3], start[3], end[3], one[3], other[3], mixed[3];
    float detector_reach = 0.0f;
    for (int e = 0; e < 2; e++) {
        for (int k = 0; k < 3; k++) {
            a[e][k] = corners[1][e][k] - corners[0][e][k];
            b[e][k] = corners[2][e][k] - corners[0][e][k];
            c[e][k] = corners[0][e][k] - f32x8_all(tree->detector[e][k]);
            float d = tree->detector[e][k] < 0.0f ? -tree->detector[e][k] : tree->detector[e][k];
            detector_reach = d > detector_reach ? d : detector_reach;
        }
    }
    f32x8 size_a = largest_component(a), size_b = largest_component(b), size_c = largest_component(c);
    f32x8 bound = f32x8_all(0x1p-18f * (tree->reach + detector_reach)) *
                      (size_c * (size_a + size_b) + f32x8_all(4.0f) * size_a * size_b) +
                  f32x8_all(0x1p-100f);
    cross_f32x8(a[0], b[0], start);
    cross_f32x8(a[1], b[1], end);
    cross_f32x8(a[1], b[0], one);
    cross_f32x8(a[0], b[1], other);
    for (int k = 0; k < 3; k++) mixed[k] = one[k] + other[k];
    f32x8 s[4] = {dot_f32x8(start, c[0]), dot_f32x8(mixed, c[0]) + dot_f32x8(start, c[1]),
                  dot_f32x8(mixed, c[1]) + dot_f32x8(end, c[0]), dot_f32x8(end, c[1])};
    f32x8 least = f32x8_min(f32x8_min(s[0], s[3]), f32x8_min(s[1], s[2]));
    f32x8 greatest = f32x8_max(f32x8_max(s[0], s[3]), f32x8_max(s[1], s[2]));
    *plus = f32x8_below(bound, least);
    *minus = f32x8_below(greatest, -bound);
    if (lasting == NULL) return;
    *stretches =
        lasting_stretch(a[0], b[0], c[0], start, f32x8_max(least, -greatest) - bound, lasting->distance);
    uint32_t last = f32x8_below(f32x8_all(lasting->stretch), *stretches);
    *plus &= last;
    *minus &= last;
}

static uint32_t clean_lanes(const bvh_leaf *l, uint32_t used, const bool *clean) {
    uint32_t lanes = 0;
    for (int lane = 0; lane < LANES; lane++) {
        uint32_t triangle = l->triangles[(used >> lane & 1) != 0 ? lane : 0];
        lanes |= (uint32_t)clean[triangle] << lane;
    }
    return lanes & used;
}

_Static_assert((ORIENTATION_ZERO ^ 2) == ORIENTATION_PLUS && (ORIENTATION_ZERO ^ 1) == ORIENTATION_MINUS,
               "written without branches below");

/* Unused lanes follow the used ones, and repeat the first triangle. */
static void store_orientations(const bvh_leaf *l, uint32_t used, uint32_t plus, uint32_t minus,
                               uint8_t *orientations) {
    for (int lane = LANES - 1; lane >= 0; lane--) {
        int from = (used >> lane & 1) != 0 ? lane : 0;
        uint32_t flag = ORIENTATION_ZERO ^ (plus >> from & 1) << 1 ^ (minus >> from & 1);
        orientations[l->triangles[from]] = (uint8_t)flag;
    }
}

static inline void orient_leaf(const bvh *hierarchy, const bvh_tree *tree, uint32_t index, const bool *clean,
                               const orientation_lasting *lasting, uint8_t *orientations) {
    const bvh_leaf *l = &hierarchy->leaves[index];
    f32x8 stretches;
    uint32_t plus, minus, used = hierarchy->leaf_flags[index].used;
    uint32_t counted = clean != NULL ? clean_lanes(l, used, clean) : used;
    leaf_corners corners;
    load_corners(hierarchy, l, corners);
    orient_lanes(tree, corners, lasting, &plus, &minus, &stretches);
    plus &= counted;
    minus &= counted;
    hierarchy->leaf_flags[index].plus = (uint8_t)plus;
    hierarchy->leaf_flags[index].minus = (uint8_t)minus;
    store_orientations(l, used, plus, minus, orientations);
    if (lasting == NULL) return;
    float least = __builtin_inff();
    for (uint32_t lanes = plus | minus; lanes != 0; lanes &= lanes - 1)
        least = stretches[__builtin_ctz(lanes)] < least ? stretches[__builtin_ctz(lanes)] : least;
    lasting->of_leaves[index] = least;
}

void SIMD_NAME(orient)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                       const bool *clean, uint8_t *orientations) {
    for (uint32_t i = begin; i < end; i++) orient_leaf(hierarchy, tree, i, clean, NULL, orientations);
}

void SIMD_NAME(orient_lasting)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                               const bool *clean, const orientation_lasting *lasting, uint8_t *orientations) {
    for (uint32_t i = begin; i < end; i++) orient_leaf(hierarchy, tree, i, clean, lasting, orientations);
}

void SIMD_NAME(orient_corners)(const bvh_tree *tree, f32x8 (*corners)[2][3], uint32_t *plus,
                               uint32_t *minus) {
    orient_lanes(tree, corners, NULL, plus, minus, NULL);
}

/* ---- how far records are from where they were at a reference ----------------------------------------------- */

double SIMD_NAME(skin_move)(bvh_skin *s, uint32_t begin, uint32_t end, const double *x,
                            const double origin[3]) {
    f64x8 farthest = f64x8_all(0.0);
    for (uint32_t i = begin; i < end; i += LANES) {
        f64x8 at[3], sum = f64x8_all(0.0);
        f32x8 rows[8];
        for (int lane = 0; lane < LANES; lane++) rows[lane] = f32x8_load(s->items[i + (uint32_t)lane]);
        f32x8_transpose(rows);
        f64x8_load_points(x, s->vertices + i, at);
        for (int k = 0; k < 3; k++) {
            f64x8 by = (at[k] - f64x8_all(origin[k])) * f64x8_all(s->scale) - f64x8_from(rows[k]);
            sum += by * by;
            rows[4 + k] = f32x8_from(by);
        }
        farthest = f64x8_max(farthest, sum);
        f32x8_transpose(rows);
        for (int lane = 0; lane < LANES; lane++) f32x8_store(s->items[i + (uint32_t)lane], rows[lane]);
    }
    double greatest = 0.0;
    for (int lane = 0; lane < LANES; lane++) greatest = farthest[lane] > greatest ? farthest[lane] : greatest;
    return greatest;
}

/* ---- signs ------------------------------------------------------------------------------------------------- */

/* The corners of a leaf at one end, in the frame of its tree, as floats; returns the largest magnitude. */
static float place_corners(const bvh_skin *s, const skin_leaf *leaf, const double *x, int end,
                           leaf_corners corners) {
    const double *origin = s->trees[leaf->tree].ends[end];
    f32x8 largest = f32x8_all(0.0f);
    for (int i = 0; i < 3; i++) {
        uint32_t vertices[LANES];
        f64x8 at[3];
        for (int lane = 0; lane < LANES; lane++)
            vertices[lane] = s->vertices[leaf->corners[i * LANES + lane]];
        f64x8_load_points(x, vertices, at);
        for (int k = 0; k < 3; k++) {
            corners[i][end][k] = f32x8_from((at[k] - f64x8_all(origin[k])) * f64x8_all(s->scale));
            largest = f32x8_max(largest, f32x8_abs(corners[i][end][k]));
        }
    }
    return f32x8_greatest(largest);
}

/* Computes the signs of a leaf for the interval. Are they what they were? */
static __attribute__((noinline)) bool keeps_signs(const bvh_skin *s, const skin_leaf *leaf, const double *x0,
                                                  const double *x1) {
    const skin_tree *of = &s->trees[leaf->tree];
    bvh_tree tree = {.reach = 0.0f};
    leaf_corners corners;
    uint32_t plus, minus;
    float start = place_corners(s, leaf, x0, 0, corners), stop = place_corners(s, leaf, x1, 1, corners);
    tree.reach = (start > stop ? start : stop) * (1.0f + 0x1p-20f);
    for (int k = 0; k < 3; k++) tree.detector[0][k] = tree.detector[1][k] = of->detector[k];
    SIMD_NAME(orient_corners)(&tree, corners, &plus, &minus);
    return (leaf->plus & ~plus) == 0 && (leaf->minus & ~minus) == 0;
}

/* The extents of what the corners of a leaf are off by bound what any two of them differ by. Signs last where these are small
 * at both ends; what they were at the start is known from the interval before. */
bool SIMD_NAME(skin_signs)(const bvh_skin *s, uint32_t begin, uint32_t end, const double *x0,
                           const double *x1) {
    for (uint32_t i = begin; i < end; i++) {
        const skin_leaf *leaf = &s->leaves[i];
        f32x8 low = f32x8_load(s->items[leaf->corners[0]]), high = low;
        for (int j = 1; j < 3 * LANES; j++) {
            f32x8 item = f32x8_load(s->items[leaf->corners[j]]);
            low = f32x8_min(low, item);
            high = f32x8_max(high, item);
        }
        f32x8 extent = high - low;
        float sum = (extent[4] * extent[4] + extent[5] * extent[5]) + extent[6] * extent[6];
        s->stray_at_end[i] = !(sum < s->stretches[i]);
        if ((s->stray_at_start[i] || s->stray_at_end[i]) && !keeps_signs(s, leaf, x0, x1)) return false;
    }
    return true;
}
