/* Notes which leaves and blocks hold no active triangle: these are not compared with each other. */
#include "runtime/bvh/bvh.h"

static uint8_t inactive_triangles(const bvh *hierarchy, uint32_t leaf, const bool *active) {
    uint8_t lanes = 0;
    for (uint32_t i = 0; i < LANES && (hierarchy->leaf_flags[leaf].used >> i & 1) != 0; i++)
        lanes |= (uint8_t)(!active[hierarchy->leaves[leaf].triangles[i]] << i);
    return lanes;
}

/* A child is inactive when all its lanes are. A tree has the number of its block on the level below. */
static uint8_t inactive_children(const bvh *hierarchy, int level, uint32_t block) {
    const bvh_level *at = &hierarchy->levels[level];
    const lane_flags *flags = level == 0 ? hierarchy->leaf_flags : at[-1].flags;
    const uint8_t *below = level == 0 ? hierarchy->leaf_inactive : at[-1].inactive_lanes;
    uint8_t lanes = 0;
    for (uint32_t i = 0; i < LANES && (at->flags[block].used >> i & 1) != 0; i++) {
        uint32_t child = at->first_children[block] + i;
        lanes |= (uint8_t)((below[child] == flags[child].used) << i);
    }
    return lanes;
}

static void drop_marks(bvh *hierarchy) {
    context_free(hierarchy->mesh->context, hierarchy->leaf_inactive);
    hierarchy->leaf_inactive = NULL;
    for (int i = 0; i < hierarchy->level_count; i++) {
        context_free(hierarchy->mesh->context, hierarchy->levels[i].inactive_lanes);
        hierarchy->levels[i].inactive_lanes = NULL;
    }
}

static bool allocate_marks(bvh *hierarchy) {
    cscd_context *context = hierarchy->mesh->context;
    hierarchy->leaf_inactive =
        context_allocate(context, hierarchy->leaf_count, sizeof *hierarchy->leaf_inactive);
    bool made = hierarchy->leaf_inactive != NULL;
    for (int i = 0; made && i < hierarchy->level_count; i++) {
        bvh_level *level = &hierarchy->levels[i];
        level->inactive_lanes = context_allocate(context, level->block_count, sizeof *level->inactive_lanes);
        made = level->inactive_lanes != NULL;
    }
    if (!made) drop_marks(hierarchy);
    return made;
}

bool bvh_set_active(bvh *hierarchy, const bool *active) {
    if (active == NULL) {
        drop_marks(hierarchy);
        return true;
    }
    if (hierarchy->leaf_inactive == NULL && !allocate_marks(hierarchy)) return false;
    for (uint32_t i = 0; i < hierarchy->leaf_count; i++)
        hierarchy->leaf_inactive[i] = inactive_triangles(hierarchy, i, active);
    for (int level = 0; level < hierarchy->level_count; level++) {
        for (uint32_t i = 0; i < hierarchy->levels[level].block_count; i++)
            hierarchy->levels[level].inactive_lanes[i] = inactive_children(hierarchy, level, i);
    }
    return true;
}

const char *bvh_check_active(const bvh *hierarchy, const bool *active) {
    if ((hierarchy->leaf_inactive != NULL) != (active != NULL))
        return "the trees and their detector have different active sets";
    if (active == NULL) return NULL;
    for (uint32_t i = 0; i < hierarchy->leaf_count; i++) {
        if (hierarchy->leaf_inactive[i] != inactive_triangles(hierarchy, i, active))
            return "a leaf has the wrong active triangles";
    }
    for (int level = 0; level < hierarchy->level_count; level++) {
        if (hierarchy->levels[level].inactive_lanes == NULL) return "a level does not know its active blocks";
        for (uint32_t i = 0; i < hierarchy->levels[level].block_count; i++) {
            if (hierarchy->levels[level].inactive_lanes[i] != inactive_children(hierarchy, level, i))
                return "a block has the wrong active children";
        }
    }
    return NULL;
}
