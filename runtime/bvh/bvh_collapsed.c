/* Notes which trees hold nothing but collapsed components, and which blocks nothing but such trees. */
#include "runtime/bvh/bvh.h"

static bool tree_is_collapsed(const bvh *f, const bvh_tree *tree, const bool *collapsed) {
    const uint32_t *components = f->mesh->triangle_components;
    uint32_t end = tree->first_leaf + tree->leaf_count;
    for (uint32_t leaf = tree->first_leaf; leaf < end; leaf++) {
        for (uint32_t i = 0; i < LANES && (f->leaf_flags[leaf].used >> i & 1) != 0; i++) {
            if (!collapsed[components[f->leaves[leaf].triangles[i]]]) return false;
        }
    }
    return true;
}

static uint8_t collapsed_children(const bvh *f, int level, uint32_t block, const bool *collapsed) {
    const bvh_level *at = &f->levels[level], *below = at - 1;
    uint8_t lanes = 0;
    for (uint32_t i = 0; i < LANES && (at->flags[block].used >> i & 1) != 0; i++) {
        uint32_t child = at->first_children[block] + i;
        bool all = level == f->tree_level ? tree_is_collapsed(f, &f->trees[child], collapsed)
                                          : below->collapsed_lanes[child] == below->flags[child].used;
        lanes |= (uint8_t)(all << i);
    }
    return lanes;
}

void bvh_free_collapsed(bvh *f) {
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(f->mesh->context, f->levels[i].collapsed_lanes);
        f->levels[i].collapsed_lanes = NULL;
    }
}

static bool allocate_marks(bvh *f) {
    for (int i = f->tree_level; i < f->level_count; i++) {
        bvh_level *level = &f->levels[i];
        if (level->collapsed_lanes == NULL)
            level->collapsed_lanes =
                context_allocate(f->mesh->context, level->block_count, sizeof *level->collapsed_lanes);
        if (level->collapsed_lanes == NULL) return false;
    }
    return true;
}

bool bvh_mark_collapsed(bvh *f, const bool *collapsed) {
    if (!allocate_marks(f)) return false;
    for (int level = f->tree_level; level < f->level_count; level++) {
        for (uint32_t block = 0; block < f->levels[level].block_count; block++)
            f->levels[level].collapsed_lanes[block] = collapsed_children(f, level, block, collapsed);
    }
    return true;
}
