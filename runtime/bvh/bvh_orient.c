/* Sets the flags of leaves and blocks: their orientations, and which triangles are newly kept. */
#include "runtime/bvh/bvh.h"

enum { LEAVES_PER_TASK = 64, BLOCKS_PER_TASK = 128 };

typedef struct orienting {
    const bvh *bvh;
    const orientation_query *view;
    uint8_t *orientations;
} orienting;

/* The detector point is defined as the rounded point in the frame of its tree, so that rounding only moves it. */
static void place_detector(const bvh *f, bvh_tree *tree, const orientation_query *view) {
    for (int e = 0; e < 2; e++) {
        for (int k = 0; k < 3; k++) {
            double offset = view->detector_offsets[tree->region][k];
            tree->detector[e][k] = (float)(tree->weighted[e][k] + offset * f->scale);
        }
    }
}

void bvh_detector_points(const bvh *f, const orientation_query *view, double (*points)[2][3]) {
    for (uint32_t i = 0; i < f->tree_count; i++) {
        const bvh_tree *tree = &f->trees[i];
        for (int e = 0; e < 2; e++) {
            for (int k = 0; k < 3; k++)
                points[tree->region][e][k] = tree->origin[e][k] + tree->weighted[e][k] / f->scale +
                                             view->detector_offsets[tree->region][k];
        }
    }
}

static uint32_t component_of(const bvh *f, const bvh_tree *tree) {
    return f->mesh->triangle_components[f->leaves[tree->first_leaf].triangles[0]];
}

static uint32_t tree_of_leaf(const bvh *f, uint32_t index) {
    uint32_t first = 0, last = f->tree_count - 1;
    while (first < last) {
        uint32_t middle = first + (last - first + 1) / 2;
        if (f->trees[middle].first_leaf <= index)
            first = middle;
        else
            last = middle - 1;
    }
    return first;
}

static void orient_task(void *data, uint32_t index) {
    const orienting *now = data;
    const bvh *f = now->bvh;
    uint32_t begin = index * LEAVES_PER_TASK, end = begin + LEAVES_PER_TASK;
    end = end < f->leaf_count ? end : f->leaf_count;
    for (uint32_t i = tree_of_leaf(f, begin); i < f->tree_count && f->trees[i].first_leaf < end; i++) {
        const bvh_tree *tree = &f->trees[i];
        if (!now->view->culled[component_of(f, tree)]) continue;
        uint32_t stop = tree->first_leaf + tree->leaf_count;
        uint32_t first = begin > tree->first_leaf ? begin : tree->first_leaf, last = end < stop ? end : stop;
        if (now->view->lasting != NULL)
            f->kernels->orient_lasting(f, tree, first, last, now->view->clean, now->view->lasting,
                                       now->orientations);
        else
            f->kernels->orient(f, tree, first, last, now->view->clean, now->orientations);
    }
}

/* ---- flags of blocks --------------------------------------------------------------------------------- */

typedef struct marking {
    const bvh *bvh;
    int level;
} marking;

static void mark_block(const bvh *f, int index, uint32_t block) {
    const bvh_level *level = &f->levels[index];
    lane_flags *flags = &level->flags[block];
    uint32_t plus = 0, minus = 0, newly_kept = 0;
    const lane_flags *children =
        (index == 0 ? f->leaf_flags : f->levels[index - 1].flags) + level->first_children[block];
    for (uint32_t i = 0; i < LANES && (flags->used >> i & 1) != 0; i++) {
        plus |= (uint32_t)(children[i].plus == children[i].used) << i;
        minus |= (uint32_t)(children[i].minus == children[i].used) << i;
        newly_kept |= (uint32_t)(children[i].newly_kept != 0) << i;
    }
    bool one_tree = index < f->tree_level;
    flags->plus = (uint8_t)(one_tree ? plus : 0);
    flags->minus = (uint8_t)(one_tree ? minus : 0);
    flags->newly_kept = (uint8_t)newly_kept;
}

static void mark_task(void *data, uint32_t index) {
    const marking *now = data;
    uint32_t begin = index * BLOCKS_PER_TASK, end = begin + BLOCKS_PER_TASK;
    uint32_t count = now->bvh->levels[now->level].block_count;
    for (uint32_t b = begin; b < end && b < count; b++) mark_block(now->bvh, now->level, b);
}

static void mark_blocks(const bvh *f) {
    marking now = {f, 0};
    for (; now.level < f->level_count; now.level++) {
        uint32_t tasks = (f->levels[now.level].block_count + BLOCKS_PER_TASK - 1) / BLOCKS_PER_TASK;
        parallel_run(f->mesh->context->threads, tasks, mark_task, &now);
    }
}

/* ---- flags of leaves --------------------------------------------------------------------------------- */

static lane_flags flags_of(const bvh *f, uint32_t index, const uint8_t *orientations) {
    lane_flags flags = {.used = f->leaf_flags[index].used};
    for (uint32_t lane = 0; lane < LANES && (flags.used >> lane & 1) != 0; lane++) {
        uint8_t flag = orientations[f->leaves[index].triangles[lane]];
        flags.plus |= (uint8_t)((flag == ORIENTATION_PLUS) << lane);
        flags.minus |= (uint8_t)((flag == ORIENTATION_MINUS) << lane);
    }
    return flags;
}

typedef struct refreshing {
    const bvh *bvh;
    const uint8_t *before, *now;
} refreshing;

static void refresh_task(void *data, uint32_t index) {
    const refreshing *r = data;
    const bvh *f = r->bvh;
    uint32_t begin = index * LEAVES_PER_TASK, end = begin + LEAVES_PER_TASK;
    for (uint32_t i = begin; i < end && i < f->leaf_count; i++) {
        lane_flags earlier = flags_of(f, i, r->before), flags = flags_of(f, i, r->now);
        flags.newly_kept = (uint8_t)((earlier.plus | earlier.minus) & ~(flags.plus | flags.minus));
        f->flags_before[i] = earlier;
        f->leaf_flags[i] = flags;
    }
}

static void run_over_leaves(const bvh *f, parallel_task *task, void *data) {
    parallel_run(f->mesh->context->threads, (f->leaf_count + LEAVES_PER_TASK - 1) / LEAVES_PER_TASK, task,
                 data);
}

void bvh_mark_newly_kept(bvh *f, const uint8_t *before, const uint8_t *now) {
    refreshing r = {f, before, now};
    run_over_leaves(f, refresh_task, &r);
    mark_blocks(f);
}

void bvh_mark_unproven(bvh *f, const bool *unproven) {
    for (uint32_t i = 0; i < f->leaf_count; i++) {
        lane_flags flags = {.used = f->leaf_flags[i].used};
        for (uint32_t lane = 0; lane < LANES && (flags.used >> lane & 1) != 0; lane++)
            flags.newly_kept |= (uint8_t)(unproven[f->leaves[i].triangles[lane]] << lane);
        f->leaf_flags[i] = flags;
    }
    mark_blocks(f);
}

void bvh_orient(bvh *f, const orientation_query *view, uint8_t *orientations) {
    orienting now = {f, view, orientations};
    for (uint32_t i = 0; i < f->tree_count; i++) place_detector(f, &f->trees[i], view);
    run_over_leaves(f, orient_task, &now);
    mark_blocks(f);
}
