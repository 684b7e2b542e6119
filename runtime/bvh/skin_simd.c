/* How far records are from where they were at a reference, eight at a time. */
#include "runtime/bvh/bvh_kernels_simd.h"
#include "runtime/bvh/leaf_volumes.h"
#include "src/core/simd_lanes.h"

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
