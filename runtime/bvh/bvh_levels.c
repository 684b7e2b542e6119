/* The blocks above the leaves of all trees, level by level. */
#include "runtime/bvh/bvh.h"

static uint32_t blocks_over(uint32_t children) {
    return (children + LANES - 1) / LANES;
}

static bool allocate_level(cscd_context *context, bvh_level *level, uint32_t block_count, int axis_count) {
    size_t floats = (size_t)axis_count * 2 * LANES;
    level->block_count = block_count;
    level->first_children = context_allocate(context, block_count, sizeof *level->first_children);
    level->bounds = context_allocate(context, block_count * floats, sizeof *level->bounds);
    level->flags = context_allocate(context, block_count, sizeof *level->flags);
    return level->first_children != NULL && level->bounds != NULL && level->flags != NULL;
}

static uint32_t add_blocks(bvh_level *level, uint32_t at, uint32_t first_child, uint32_t child_count) {
    for (uint32_t i = 0; i < child_count; i += LANES, at++) {
        uint32_t count = child_count - i < LANES ? child_count - i : LANES;
        level->first_children[at] = first_child + i;
        level->flags[at].used = (uint8_t)((1u << count) - 1);
    }
    return at;
}

/* Returns the number of levels of the largest tree, at least one. */
static int height_of(const bvh *hierarchy) {
    int height = 1;
    for (uint32_t p = 0; p < hierarchy->tree_count; p++) {
        int own = 1;
        for (uint32_t n = blocks_over(hierarchy->trees[p].leaf_count); n > 1; n = blocks_over(n)) own++;
        height = own > height ? own : height;
    }
    return height;
}

/* Adds the blocks of one level of all trees. On entry counts holds the number of children of each tree on this
 * level, on return the number of its blocks. */
static bool add_tree_level(bvh *hierarchy, int level, uint32_t *counts) {
    uint32_t total = 0, at = 0, child = 0;
    for (uint32_t p = 0; p < hierarchy->tree_count; p++) total += blocks_over(counts[p]);
    if (!allocate_level(hierarchy->mesh->context, &hierarchy->levels[level], total, hierarchy->axis_count))
        return false;
    for (uint32_t p = 0; p < hierarchy->tree_count; p++) {
        uint32_t first = hierarchy->trees[p].first_blocks[level] = at;
        at = add_blocks(&hierarchy->levels[level], at, child, counts[p]);
        for (uint32_t i = first; level == 0 && i < at; i++) hierarchy->block_trees[i] = p;
        child += counts[p];
        counts[p] = at - first;
    }
    return true;
}

bool bvh_build_levels(bvh *hierarchy, uint32_t *counts) {
    uint32_t blocks = 0;
    hierarchy->tree_level = hierarchy->level_count = height_of(hierarchy);
    for (uint32_t p = 0; p < hierarchy->tree_count; p++) {
        counts[p] = hierarchy->trees[p].leaf_count;
        blocks += blocks_over(counts[p]);
    }
    hierarchy->block_trees =
        context_allocate(hierarchy->mesh->context, blocks, sizeof *hierarchy->block_trees);
    if (hierarchy->block_trees == NULL) return false;
    for (int level = 0; level < hierarchy->tree_level; level++) {
        if (!add_tree_level(hierarchy, level, counts)) return false;
    }
    uint32_t children = hierarchy->tree_count;
    do {
        bvh_level *level = &hierarchy->levels[hierarchy->level_count++];
        if (!allocate_level(hierarchy->mesh->context, level, blocks_over(children), hierarchy->axis_count))
            return false;
        add_blocks(level, 0, 0, children);
        children = level->block_count;
    } while (children > 1);
    return true;
}

void bvh_free_levels(bvh *hierarchy) {
    cscd_context *context = hierarchy->mesh->context;
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(context, hierarchy->levels[i].first_children);
        context_free(context, hierarchy->levels[i].bounds);
        context_free(context, hierarchy->levels[i].flags);
        context_free(context, hierarchy->levels[i].self_pairs);
        context_free(context, hierarchy->levels[i].inactive_lanes);
        hierarchy->levels[i] = (bvh_level){0};
    }
}
