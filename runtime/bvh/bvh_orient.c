/* Sets the flags of leaves and blocks: their orientations, and which triangles are newly kept. */
#include "runtime/bvh/bvh_parts.h"

enum { LEAVES_PER_TASK = 64, BLOCKS_PER_TASK = 128 };

typedef struct orienting {
    const bvh *bvh;
    const orientation_query *view;
    uint8_t *orientations;
} orienting;

/* The detector point is defined as the rounded point in the frame of its tree, so that rounding only moves it. */
static void place_detector(const bvh *hierarchy, bvh_tree *tree, const orientation_query *view) {
    for (int e = 0; e < 2; e++) {
        for (int k = 0; k < 3; k++) {
            double offset = view->detector_offsets[tree->region][k];
            tree->detector[e][k] = (float)(tree->weighted[e][k] + offset * hierarchy->scale);
        }
    }
}

void bvh_detector_points(const bvh *hierarchy, const orientation_query *view, double (*points)[2][3]) {
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        const bvh_tree *tree = &hierarchy->trees[i];
        for (int e = 0; e < 2; e++) {
            for (int k = 0; k < 3; k++)
                points[tree->region][e][k] = tree->origin[e][k] + tree->weighted[e][k] / hierarchy->scale +
                                             view->detector_offsets[tree->region][k];
        }
    }
}

static uint32_t tree_of_leaf(const bvh *hierarchy, uint32_t index) {
    uint32_t first = 0, last = hierarchy->tree_count - 1;
    while (first < last) {
        uint32_t middle = first + (last - first + 1) / 2;
        if (hierarchy->trees[middle].first_leaf <= index)
            first = middle;
        else
            last = middle - 1;
    }
    return first;
}

static void orient_task(void *data, uint32_t index) {
    const orienting *now = data;
    const bvh *hierarchy = now->bvh;
    uint32_t begin = index * LEAVES_PER_TASK, end = begin + LEAVES_PER_TASK;
    end = end < hierarchy->leaf_count ? end : hierarchy->leaf_count;
    for (uint32_t i = tree_of_leaf(hierarchy, begin);
         i < hierarchy->tree_count && hierarchy->trees[i].first_leaf < end; i++) {
        const bvh_tree *tree = &hierarchy->trees[i];
        if (!now->view->culled[bvh_tree_component(hierarchy, tree)]) continue;
        uint32_t stop = tree->first_leaf + tree->leaf_count;
        uint32_t first = begin > tree->first_leaf ? begin : tree->first_leaf, last = end < stop ? end : stop;
        if (now->view->lasting != NULL)
            hierarchy->kernels->orient_lasting(hierarchy, tree, first, last, now->view->clean,
                                               now->view->lasting, now->orientations);
        else
            hierarchy->kernels->orient(hierarchy, tree, first, last, now->view->clean, now->orientations);
    }
}

/* ---- flags of blocks --------------------------------------------------------------------------------- */

typedef struct marking {
    const bvh *bvh;
    int level;
} marking;

static void mark_block(const bvh *hierarchy, int index, uint32_t block) {
    const bvh_level *level = &hierarchy->levels[index];
    lane_flags *flags = &level->flags[block];
    uint32_t plus = 0, minus = 0, newly_kept = 0;
    const lane_flags *children = (index == 0 ? hierarchy->leaf_flags : hierarchy->levels[index - 1].flags) +
                                 level->first_children[block];
    for (uint32_t i = 0; i < LANES && (flags->used >> i & 1) != 0; i++) {
        plus |= (uint32_t)(children[i].plus == children[i].used) << i;
        minus |= (uint32_t)(children[i].minus == children[i].used) << i;
        newly_kept |= (uint32_t)(children[i].newly_kept != 0) << i;
    }
    bool one_tree = index < hierarchy->tree_level;
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

static void mark_blocks(const bvh *hierarchy) {
    marking now = {hierarchy, 0};
    for (; now.level < hierarchy->level_count; now.level++) {
        uint32_t tasks = (hierarchy->levels[now.level].block_count + BLOCKS_PER_TASK - 1) / BLOCKS_PER_TASK;
        parallel_run(hierarchy->mesh->context->threads, tasks, mark_task, &now);
    }
}

/* ---- flags of leaves --------------------------------------------------------------------------------- */

static lane_flags flags_of(const bvh *hierarchy, uint32_t index, const uint8_t *orientations) {
    lane_flags flags = {.used = hierarchy->leaf_flags[index].used};
    for (uint32_t lane = 0; lane < LANES && (flags.used >> lane & 1) != 0; lane++) {
        uint8_t flag = orientations[hierarchy->leaves[index].triangles[lane]];
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
    const bvh *hierarchy = r->bvh;
    uint32_t begin = index * LEAVES_PER_TASK, end = begin + LEAVES_PER_TASK;
    for (uint32_t i = begin; i < end && i < hierarchy->leaf_count; i++) {
        lane_flags earlier = flags_of(hierarchy, i, r->before), flags = flags_of(hierarchy, i, r->now);
        flags.newly_kept = (uint8_t)((earlier.plus | earlier.minus) & ~(flags.plus | flags.minus));
        hierarchy->flags_before[i] = earlier;
        hierarchy->leaf_flags[i] = flags;
    }
}

static void run_over_leaves(const bvh *hierarchy, parallel_task *task, void *data) {
    parallel_run(hierarchy->mesh->context->threads,
                 (hierarchy->leaf_count + LEAVES_PER_TASK - 1) / LEAVES_PER_TASK, task, data);
}

void bvh_mark_newly_kept(bvh *hierarchy, const uint8_t *before, const uint8_t *now) {
    refreshing r = {hierarchy, before, now};
    run_over_leaves(hierarchy, refresh_task, &r);
    mark_blocks(hierarchy);
}

void bvh_mark_unproven(bvh *hierarchy, const bool *unproven) {
    for (uint32_t i = 0; i < hierarchy->leaf_count; i++) {
        lane_flags flags = {.used = hierarchy->leaf_flags[i].used};
        for (uint32_t lane = 0; lane < LANES && (flags.used >> lane & 1) != 0; lane++)
            flags.newly_kept |= (uint8_t)(unproven[hierarchy->leaves[i].triangles[lane]] << lane);
        hierarchy->leaf_flags[i] = flags;
    }
    mark_blocks(hierarchy);
}

void bvh_orient(bvh *hierarchy, const orientation_query *view, uint8_t *orientations) {
    orienting now = {hierarchy, view, orientations};
    for (uint32_t i = 0; i < hierarchy->tree_count; i++)
        place_detector(hierarchy, &hierarchy->trees[i], view);
    run_over_leaves(hierarchy, orient_task, &now);
    mark_blocks(hierarchy);
}
