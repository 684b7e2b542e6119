/* Refits the BVH to an interval: frames, records, bounds, flags. */
#include "runtime/bvh/bvh_parts.h"
#include "src/core/floating.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

/* Tasks take a few microseconds each. Blocks of level 0 cost most. Levels of fewer than SHARED_BLOCKS_MIN blocks run
 * on one thread. */
enum { SAMPLE_COUNT = 64, SHARED_BLOCKS_MIN = 64, LOW_BLOCKS_PER_TASK = 8, HIGH_BLOCKS_PER_TASK = 128 };

/* No product of the kernels overflows or underflows while the reach lies between these two. */
static const double least_reach = 0x1p-16, greatest_reach = 0x1p16;

typedef struct moving {
    bvh *bvh;
    const double *x0, *x1;
    volume_growth growth;
    int level;
} moving;

/* ---- frames and records -------------------------------------------------------------------------------- */

/* The origins are the means of a few vertices, since any points will do. The difference of the two origins is the
 * common displacement of the tree, which is thereby taken out of all its volumes. */
static void place_frame(const bvh *hierarchy, bvh_tree *tree, const moving *m) {
    uint32_t step = tree->record_count / SAMPLE_COUNT + 1, count = 0;
    double sums[2][3] = {{0.0}};
    const double *first = m->x0 + (size_t)hierarchy->record_vertices[tree->first_record] * 3;
    for (uint32_t i = 0; i < tree->record_count; i += step, count++) {
        size_t at = (size_t)hierarchy->record_vertices[tree->first_record + i] * 3;
        for (size_t k = 0; k < 3; k++) {
            sums[0][k] += m->x0[at + k] - first[k];
            sums[1][k] += m->x1[at + k] - first[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        tree->origin[0][k] = first[k] + sums[0][k] / count;
        tree->origin[1][k] = first[k] + sums[1][k] / count;
    }
}

static void copy_chunk(void *data, uint32_t index) {
    const moving *now = data;
    const bvh *hierarchy = now->bvh;
    record_chunk *c = &hierarchy->chunks[index];
    hierarchy->kernels->copy_in(hierarchy, &hierarchy->trees[c->tree], c->begin, c->end, now->x0, now->x1,
                                &c->copied);
}

/* Copies all records; returns the largest magnitude of a coordinate. */
static double copy_records(moving *now) {
    const bvh *hierarchy = now->bvh;
    double reach = 0.0;
    parallel_run(hierarchy->mesh->context->threads, hierarchy->chunk_count, copy_chunk, now);
    for (uint32_t i = 0; i < hierarchy->chunk_count; i++)
        reach = hierarchy->chunks[i].copied.reach > reach ? hierarchy->chunks[i].copied.reach : reach;
    return reach;
}

/* Chooses the slack. With u = 2^-24 and M the reach, records are off by u M, and rounding a bound outward rounds it
 * once more.
 * - Along axes a bound is off by at most 2.1 u M; the code takes 4 u M.
 * - Along diagonals the records contribute 3 u M, two additions of sums up to 2 M and 3 M contribute 5 u M, and
 *   rounding the bound contributes 3 u M, together at most 11.1 u M; the code takes 16 u M.
 * Volumes are each widened by half a distance d, along diagonals by sqrt 3 / 2 of it, so they overlap where features
 * come within d. */
static void finish_tree(bvh_tree *tree, double distance, const copied *sum) {
    tree->reach = float_above(sum->reach);
    tree->slack[0] = float_above(sum->reach * 0x1p-22 + 0.5 * distance);
    tree->slack[1] = float_above(sum->reach * 0x1p-20 + 0.8660254038 * distance);
    memcpy(tree->weighted, sum->weighted, sizeof tree->weighted);
}

static double tree_distance(const bvh_tree *tree, const volume_growth *growth) {
    double distance = growth->distance;
    if (growth->of_objects != NULL) distance = max_of(growth->of_objects[tree->object], distance);
    return distance + growth->beyond;
}

static double greatest_distance(const bvh *hierarchy, const volume_growth *growth) {
    double greatest = 0.0;
    for (uint32_t i = 0; i < hierarchy->tree_count; i++)
        greatest = fmax(greatest, tree_distance(&hierarchy->trees[i], growth));
    return greatest;
}

/* Chunks are sorted by tree. */
static void finish_trees(const bvh *hierarchy, const volume_growth *growth) {
    for (uint32_t i = 0, at = 0; i < hierarchy->tree_count; i++) {
        copied sum = {0};
        for (; at < hierarchy->chunk_count && hierarchy->chunks[at].tree == i; at++) {
            const copied *c = &hierarchy->chunks[at].copied;
            sum.reach = c->reach > sum.reach ? c->reach : sum.reach;
            for (int k = 0; k < 6; k++) sum.weighted[k / 3][k % 3] += c->weighted[k / 3][k % 3];
        }
        finish_tree(&hierarchy->trees[i], tree_distance(&hierarchy->trees[i], growth) * hierarchy->scale,
                    &sum);
    }
}

static void move_records(moving *now) {
    bvh *hierarchy = now->bvh;
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) place_frame(hierarchy, &hierarchy->trees[i], now);
    double reach = copy_records(now);
    if (reach > greatest_reach || (reach > 0.0 && reach < least_reach)) {
        int exponent;
        frexp(reach, &exponent);
        hierarchy->scale = ldexp(hierarchy->scale, -exponent);
        copy_records(now);
    }
    finish_trees(hierarchy, &now->growth);
}

/* ---- bounds -------------------------------------------------------------------------------------------- */

static uint32_t blocks_per_task(const bvh *hierarchy, int level) {
    uint32_t count = hierarchy->levels[level].block_count;
    if (count < SHARED_BLOCKS_MIN) return count;
    return level == 0 ? LOW_BLOCKS_PER_TASK : HIGH_BLOCKS_PER_TASK;
}

static void refit_task(void *data, uint32_t index) {
    const moving *now = data;
    const bvh *hierarchy = now->bvh;
    uint32_t size = blocks_per_task(hierarchy, now->level), begin = index * size;
    uint32_t rest = hierarchy->levels[now->level].block_count - begin;
    hierarchy->kernels->refit(hierarchy, now->level, begin, begin + (rest < size ? rest : size));
}

static void refit_level(moving *now) {
    const bvh *hierarchy = now->bvh;
    uint32_t size = blocks_per_task(hierarchy, now->level);
    uint32_t tasks = (hierarchy->levels[now->level].block_count + size - 1) / size;
    parallel_run(hierarchy->mesh->context->threads, tasks, refit_task, now);
}

/* Where trees are too far apart for floats, a low bound stays finite and a high one goes to infinity, or the other way
 * round: the bounds still hold the tree, and two such trees overlap. */
static float low_bound(double x) {
    return (float)fmin(x, (double)FLT_MAX);
}

static float high_bound(double x) {
    return (float)fmax(x, -(double)FLT_MAX);
}

/* Writes a tree's volume over the interval in the frame of another tree, rounded outward by 2^-20 of what is
 * added. */
static void place_tree(const bvh *hierarchy, const bvh_tree *tree, const float *own, const bvh_tree *frame,
                       float *bounds) {
    double from[2][3], size = 4.0 * (double)tree->reach;
    for (int i = 0; i < 6; i++) {
        double origin = tree->origin[i / 3][i % 3], at = frame->origin[i / 3][i % 3];
        from[i / 3][i % 3] = (origin - at) * hierarchy->scale;
        size += fabs(from[i / 3][i % 3]) + 0x1p-30 * hierarchy->scale * (fabs(origin) + fabs(at));
    }
    for (int k = 0; k < hierarchy->axis_count; k++) {
        double low = INFINITY, high = -INFINITY;
        double start = kdop_along(from[0], k), end = kdop_along(from[1], k);
        for (int i = 0; i < LANES; i++) {
            /* In this order a NaN, of an unused lane that has grown without bounds, is passed over. */
            low = min_of((double)own[2 * k * LANES + i], low);
            high = max_of((double)own[(2 * k + 1) * LANES + i], high);
        }
        bounds[2 * k * LANES] = low_bound(low + fmin(start, end) - 0x1p-20 * size);
        bounds[(2 * k + 1) * LANES] = high_bound(high + fmax(start, end) + 0x1p-20 * size);
    }
}

static void place_nothing(const bvh *hierarchy, float *bounds) {
    for (int k = 0; k < hierarchy->axis_count; k++) {
        bounds[2 * k * LANES] = INFINITY;
        bounds[(2 * k + 1) * LANES] = -INFINITY;
    }
}

/* Computes the bounds on the tree level. Block i of the level below is the only block there of tree i. */
static void place_trees(const bvh *hierarchy) {
    const bvh_level *level = &hierarchy->levels[hierarchy->tree_level];
    size_t stride = (size_t)hierarchy->axis_count * 2 * LANES;
    const float *roots = hierarchy->levels[hierarchy->tree_level - 1].bounds;
    for (uint32_t i = 0; hierarchy->tree_count > 1 && i < level->block_count * LANES; i++) {
        float *bounds = level->bounds + i / LANES * stride + i % LANES;
        if (i < hierarchy->tree_count)
            place_tree(hierarchy, &hierarchy->trees[i], roots + i * stride, &hierarchy->trees[0], bounds);
        else
            place_nothing(hierarchy, bounds);
    }
}

/* ---- all of it ----------------------------------------------------------------------------------------- */

static void clear_flags(lane_flags *flags, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) flags[i] = (lane_flags){.used = flags[i].used};
}

void bvh_show_all(bvh *hierarchy) {
    if (hierarchy->leaf_self_pairs != NULL)
        memset(hierarchy->leaf_self_pairs, 0xff, hierarchy->leaf_count * sizeof *hierarchy->leaf_self_pairs);
    for (int i = 0; i < hierarchy->tree_level; i++) {
        bvh_level *level = &hierarchy->levels[i];
        if (level->self_pairs != NULL)
            memset(level->self_pairs, 0xff, level->block_count * sizeof *level->self_pairs);
    }
}

void bvh_refit(bvh *hierarchy, const double *x0, const double *x1, volume_growth growth) {
    moving now = {hierarchy, x0, x1, growth, 0};
    hierarchy->still = x0 == x1;
    move_records(&now);
    for (; now.level < hierarchy->level_count; now.level++) {
        if (now.level == hierarchy->tree_level)
            place_trees(hierarchy);
        else
            refit_level(&now);
        clear_flags(hierarchy->levels[now.level].flags, hierarchy->levels[now.level].block_count);
    }
    clear_flags(hierarchy->leaf_flags, hierarchy->leaf_count);
    hierarchy->hub_distance = greatest_distance(hierarchy, &growth);
    bvh_refit_second_volumes(hierarchy, x0, x1);
    bvh_show_all(hierarchy);
    /* A distance that floats cannot hold leaves the bounds of empty lanes without a value, so bounds are checked
     * only where no distance widens them. */
    assert(bvh_validate(hierarchy, growth.distance + growth.beyond == 0.0 && growth.of_objects == NULL) ==
           NULL);
}

void bvh_skip_adjacent(bvh *hierarchy, const bool *components) {
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        bvh_tree *tree = &hierarchy->trees[i];
        tree->skip_adjacent = components != NULL && components[bvh_tree_component(hierarchy, tree)];
    }
    hierarchy->keeps_hub_pairs = false;
}

void bvh_skip_all_adjacent(bvh *hierarchy) {
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) hierarchy->trees[i].skip_adjacent = true;
    hierarchy->keeps_hub_pairs = hierarchy->levels[0].child_hubs != NULL;
}
