/* Measures how far a point is from boxes: those of a block's children, and those of a leaf's triangles. */
#include "runtime/bvh/bvh_simd.h"

#include <math.h>

/* Adds the square of the gap between the point and a box along one axis. */
static f32x8 add_gap(f32x8 sum, f32x8 low, f32x8 high, const framed_query *q, int k) {
    const f32x8 gap =
        f32x8_max(f32x8_max(low - f32x8_all(q->high[k]), f32x8_all(q->low[k]) - high), f32x8_all(0.0f));
    return sum + gap * gap;
}

void SIMD_NAME(near_children)(const float *bounds, const framed_query *q, float *out) {
    f32x8 sum = f32x8_all(0.0f);
    for (int k = 0; k < BOX_AXES; k++)
        sum =
            add_gap(sum, f32x8_load(bounds + 2 * k * LANES), f32x8_load(bounds + (2 * k + 1) * LANES), q, k);
    f32x8_store(out, sum);
}

static f32x8 dot_of(const f32x8 a[3], const f32x8 b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Finds the triangles whose planes are farther from the point p than the square root of most. With corners and p as they are
 * rounded here, the distance from the plane is |h| / |n|, with n the product of two sides of squared lengths a and b, and
 * h = n w, w from a corner to p. With u = 2^-24, n is off by less than 8 u sqrt(ab), and h by less than 16 u sqrt(ab) |w|. As
 * (x - e)^2 > x^2 (1 - t) - e^2 / t, and the same with +, for t = 2^-10, that is less than 2^-30 ab w w in h h, and 2^-31 ab in
 * n n; the rest of 2^-8 is for the squares and sums here. What underflow loses is below 2^-140; so of sides of these lengths
 * the errors stay above it, and 2^-100 covers what is left. What overflows is no number, or far. */
static uint32_t planes_beyond(leaf_corners corners, const float p[3], float most) {
    f32x8 ab[3], ac[3], w[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = corners[1][0][k] - corners[0][0][k];
        ac[k] = corners[2][0][k] - corners[0][0][k];
        w[k] = f32x8_all(p[k]) - corners[0][0][k];
    }
    const f32x8 n[3] = {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2],
                        ab[0] * ac[1] - ab[1] * ac[0]};
    const f32x8 a = dot_of(ab, ab), b = dot_of(ac, ac), h = dot_of(n, w), size = a * b;
    const f32x8 height = h * h * f32x8_all(1.0f - 0x1p-8f) - f32x8_all(0x1p-30f) * size * dot_of(w, w);
    const f32x8 reach = f32x8_all(most) * (dot_of(n, n) + f32x8_all(0x1p-31f) * size);
    return f32x8_below(reach + f32x8_all(0x1p-100f), height) &
           f32x8_below(f32x8_all(0x1p-44f), f32x8_min(a, b)) &
           f32x8_below(f32x8_max(a, b), f32x8_all(0x1p40f));
}

/* The slack is more than twice what corners are off by, and half the width of the framed point, in each direction, bounds what
 * its middle is off by. */
static float reach_of_planes(const bvh_tree *tree, const framed_query *q, double squared, float p[3]) {
    double off = (double)tree->slack[0];
    for (int k = 0; k < 3; k++) {
        p[k] = 0.5f * q->low[k] + 0.5f * q->high[k];
        off += (double)q->high[k] - (double)q->low[k];
    }
    const double most = (squared < 0x1p60 ? sqrt(squared) : (double)INFINITY) + off;
    return (float)(most * most * (1.0 + 0x1p-20));
}

uint32_t SIMD_NAME(near_triangles)(const bvh *hierarchy, const bvh_tree *tree, const bvh_leaf *leaf,
                                   const framed_query *q, double squared) {
    leaf_corners corners;
    f32x8 sum = f32x8_all(0.0f), low[BOX_AXES], high[BOX_AXES];
    float p[3];
    const float most = reach_of_planes(tree, q, squared, p);
    load_corners(hierarchy, leaf, corners);
    enclose_corners(corners[0][0], corners[1][0], corners[2][0], BOX_AXES, tree->slack[0], low, high);
    for (int k = 0; k < BOX_AXES; k++) sum = add_gap(sum, low[k], high[k], q, k);
    return ~(f32x8_below(f32x8_all(most), sum) | planes_beyond(corners, p, most));
}
