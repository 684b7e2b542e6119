/* Notes which trees hold nothing but collapsed components, and which blocks nothing but such trees. */
#include "runtime/bvh/bvh.h"

static bool tree_is_collapsed(const bvh *hierarchy, const bvh_tree *tree, const bool *collapsed) {
    const uint32_t *components = hierarchy->mesh->triangle_components;
    uint32_t end = tree->first_leaf + tree->leaf_count;
    for (uint32_t leaf = tree->first_leaf; leaf < end; leaf++) {
        for (uint32_t i = 0; i < LANES && (hierarchy->leaf_flags[leaf].used >> i & 1) != 0; i++) {
            if (!collapsed[components[hierarchy->leaves[leaf].triangles[i]]]) return false;
        }
    }
    return true;
}

static uint8_t collapsed_children(const bvh *hierarchy, int level, uint32_t block, const bool *collapsed) {
    const bvh_level *at = &hierarchy->levels[level], *below = at - 1;
    uint8_t lanes = 0;
    for (uint32_t i = 0; i < LANES && (at->flags[block].used >> i & 1) != 0; i++) {
        uint32_t child = at->first_children[block] + i;
        bool all = level == hierarchy->tree_level
                       ? tree_is_collapsed(hierarchy, &hierarchy->trees[child], collapsed)
                       : below->collapsed_lanes[child] == below->flags[child].used;
        lanes |= (uint8_t)(all << i);
    }
    return lanes;
}

void bvh_free_collapsed(bvh *hierarchy) {
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(hierarchy->mesh->context, hierarchy->levels[i].collapsed_lanes);
        hierarchy->levels[i].collapsed_lanes = NULL;
    }
}

static bool allocate_marks(bvh *hierarchy) {
    for (int i = hierarchy->tree_level; i < hierarchy->level_count; i++) {
        bvh_level *level = &hierarchy->levels[i];
        if (level->collapsed_lanes == NULL)
            level->collapsed_lanes = context_allocate(hierarchy->mesh->context, level->block_count,
                                                      sizeof *level->collapsed_lanes);
        if (level->collapsed_lanes == NULL) return false;
    }
    return true;
}

bool bvh_mark_collapsed(bvh *hierarchy, const bool *collapsed) {
    if (!allocate_marks(hierarchy)) return false;
    for (int level = hierarchy->tree_level; level < hierarchy->level_count; level++) {
        for (uint32_t block = 0; block < hierarchy->levels[level].block_count; block++)
            hierarchy->levels[level].collapsed_lanes[block] =
                collapsed_children(hierarchy, level, block, collapsed);
    }
    return true;
}
