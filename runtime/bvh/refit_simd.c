/* Refit: records of positions at both ends of the interval, in the order of the leaves, and bounds of leaves and blocks. */
#include "runtime/bvh/bvh_simd.h"

/* ---- records ----------------------------------------------------------------------------------------------- */

static void load_scaled(const double *x, const uint32_t *vertices, const double origin[3], double scale,
                        f64x8 out[3]) {
    f64x8_load_points(x, vertices, out);
    for (int k = 0; k < 3; k++) out[k] = (out[k] - f64x8_all(origin[k])) * f64x8_all(scale);
}

static void store_records(f64x8 start[3], f64x8 end[3], float (*records)[8]) {
    f32x8 rows[8];
    for (int k = 0; k < 3; k++) {
        rows[k] = f32x8_from(start[k]);
        rows[4 + k] = f32x8_from(end[k]);
    }
    rows[3] = rows[7] = f32x8_all(0.0f);
    f32x8_transpose(rows);
    for (int i = 0; i < LANES; i++) f32x8_store(records[i], rows[i]);
}

static double sum_of(f64x8 v) {
    return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

void SIMD_NAME(copy_in)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                        const double *x0, const double *x1, copied *out) {
    f64x8 reach = f64x8_all(0.0), start_sum[3], end_sum[3];
    for (int k = 0; k < 3; k++) start_sum[k] = end_sum[k] = f64x8_all(0.0);
    for (uint32_t i = begin; i < end; i += LANES) {
        f64x8 start[3], stop[3], weight = f64x8_from(f32x8_load(hierarchy->record_weights + i));
        load_scaled(x0, hierarchy->record_vertices + i, tree->origin[0], hierarchy->scale, start);
        load_scaled(x1, hierarchy->record_vertices + i, tree->origin[1], hierarchy->scale, stop);
        for (int k = 0; k < 3; k++) {
            reach = f64x8_max(reach, f64x8_max(f64x8_abs(start[k]), f64x8_abs(stop[k])));
            start_sum[k] += weight * start[k];
            end_sum[k] += weight * stop[k];
        }
        store_records(start, stop, hierarchy->records + i);
    }
    out->reach = 0.0;
    for (int i = 0; i < LANES; i++) out->reach = reach[i] > out->reach ? reach[i] : out->reach;
    for (int k = 0; k < 3; k++) {
        out->weighted[0][k] = sum_of(start_sum[k]);
        out->weighted[1][k] = sum_of(end_sum[k]);
    }
}

/* ---- bounds ------------------------------------------------------------------------------------------------ */

/* Finds the least and greatest coordinates of a leaf's records, lane by lane. */
static void enclose_records(const bvh *hierarchy, const bvh_leaf *l, f32x8 *low, f32x8 *high) {
    f32x8 least = f32x8_load(hierarchy->records[l->corners[0][0]]), greatest = least;
    for (int i = 0; i < 3; i++) {
        for (int lane = 0; lane < LANES; lane++) {
            f32x8 record = f32x8_load(hierarchy->records[l->corners[i][lane]]);
            least = f32x8_min(least, record);
            greatest = f32x8_max(greatest, record);
        }
    }
    *low = least;
    *high = greatest;
}

/* Turns the rows of eight leaves into the bounds of a block along x, y, z. */
static void store_boxes(f32x8 low[8], f32x8 high[8], float slack, float *bounds) {
    f32x8_transpose(low);
    f32x8_transpose(high);
    for (int k = 0; k < 3; k++) {
        f32x8_store(bounds + 2 * k * LANES, f32x8_min(low[k], low[4 + k]) - f32x8_all(slack));
        f32x8_store(bounds + (2 * k + 1) * LANES, f32x8_max(high[k], high[4 + k]) + f32x8_all(slack));
    }
}

/* Stores the bounds of one child along the diagonals. */
static void store_diagonals(leaf_corners corners, const float slack[2], int lane, float *bounds) {
    leaf_volumes v;
    volumes_of(corners, slack, false, &v);
    for (int k = BOX_AXES; k < KDOP_AXES; k++) {
        bounds[2 * k * LANES + lane] = f32x8_least(f32x8_min(v.low[0][k], v.low[1][k]));
        bounds[(2 * k + 1) * LANES + lane] = f32x8_greatest(f32x8_max(v.high[0][k], v.high[1][k]));
    }
}

/* Computes the bounds of a block of level 0. */
static void enclose_leaves(const bvh *hierarchy, uint32_t block) {
    const bvh_tree *tree = &hierarchy->trees[hierarchy->block_trees[block]];
    const bvh_level *level = &hierarchy->levels[0];
    float *bounds = level->bounds + (size_t)block * (size_t)hierarchy->axis_count * 2 * LANES;
    f32x8 low[8], high[8];
    for (uint32_t lane = 0; lane < LANES; lane++) {
        uint32_t index = level->first_children[block] + lane;
        if ((level->flags[block].used >> lane & 1) == 0) {
            low[lane] = f32x8_all(__builtin_inff());
            high[lane] = f32x8_all(-__builtin_inff());
            for (int k = 3; k < hierarchy->axis_count; k++) {
                bounds[2 * k * LANES + (int)lane] = __builtin_inff();
                bounds[(2 * k + 1) * LANES + (int)lane] = -__builtin_inff();
            }
            continue;
        }
        enclose_records(hierarchy, &hierarchy->leaves[index], &low[lane], &high[lane]);
        if (hierarchy->axis_count == BOX_AXES) continue;
        leaf_corners corners;
        load_corners(hierarchy, &hierarchy->leaves[index], corners);
        store_diagonals(corners, tree->slack, (int)lane, bounds);
    }
    store_boxes(low, high, tree->slack[0], bounds);
}

/* Computes the bounds of a block of a higher level. */
static void enclose_blocks(const bvh *hierarchy, int index, uint32_t block) {
    const bvh_level *level = &hierarchy->levels[index], *below = level - 1;
    size_t stride = (size_t)hierarchy->axis_count * 2 * LANES;
    float *bounds = level->bounds + block * stride;
    const float *children = below->bounds + level->first_children[block] * stride;
    for (int k = 0; k < hierarchy->axis_count; k++) {
        f32x8 low[8], high[8];
        for (uint32_t i = 0; i < LANES; i++) {
            bool used = (level->flags[block].used >> i & 1) != 0;
            const float *child = children + i * stride + (size_t)k * 2 * LANES;
            low[i] = used ? f32x8_load(child) : f32x8_all(__builtin_inff());
            high[i] = used ? f32x8_load(child + LANES) : f32x8_all(-__builtin_inff());
        }
        f32x8_transpose(low);
        f32x8_transpose(high);
        for (int i = 1; i < LANES; i++) {
            low[0] = f32x8_min(low[0], low[i]);
            high[0] = f32x8_max(high[0], high[i]);
        }
        f32x8_store(bounds + 2 * k * LANES, low[0]);
        f32x8_store(bounds + (2 * k + 1) * LANES, high[0]);
    }
}

void SIMD_NAME(refit)(const bvh *hierarchy, int level, uint32_t begin, uint32_t end) {
    for (uint32_t block = begin; block < end; block++) {
        if (level == 0)
            enclose_leaves(hierarchy, block);
        else
            enclose_blocks(hierarchy, level, block);
    }
}

/* Empty lanes repeat the first triangle, so they do not extend the leaf. They count as triangles, but always the
 * same ones, so spreads can be compared. */
extents SIMD_NAME(extents_at_start)(const bvh *hierarchy) {
    extents sum = {0.0, 0.0};
    for (uint32_t i = 0; i < hierarchy->leaf_count; i++) {
        leaf_corners corners;
        float whole = 0.0f;
        f32x8 of_triangles = f32x8_all(0.0f);
        load_corners(hierarchy, &hierarchy->leaves[i], corners);
        for (int k = 0; k < BOX_AXES; k++) {
            f32x8 low = f32x8_min(f32x8_min(corners[0][0][k], corners[1][0][k]), corners[2][0][k]);
            f32x8 high = f32x8_max(f32x8_max(corners[0][0][k], corners[1][0][k]), corners[2][0][k]);
            whole += f32x8_greatest(high) - f32x8_least(low);
            of_triangles += high - low;
        }
        sum.leaves += (double)whole;
        for (int lane = 0; lane < LANES; lane++) sum.triangles += (double)of_triangles[lane];
    }
    return sum;
}
