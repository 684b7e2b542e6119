/* Notes which leaves and blocks hold no active triangle: these are not compared with each other. */
#include "runtime/bvh/bvh.h"

static uint8_t inactive_triangles(const bvh *f, uint32_t leaf, const bool *active) {
    uint8_t lanes = 0;
    for (uint32_t i = 0; i < LANES && (f->leaf_flags[leaf].used >> i & 1) != 0; i++)
        lanes |= (uint8_t)(!active[f->leaves[leaf].triangles[i]] << i);
    return lanes;
}

/* A child is inactive when all its lanes are. A tree has the number of its block on the level below. */
static uint8_t inactive_children(const bvh *f, int level, uint32_t block) {
    const bvh_level *at = &f->levels[level];
    const lane_flags *flags = level == 0 ? f->leaf_flags : at[-1].flags;
    const uint8_t *below = level == 0 ? f->leaf_inactive : at[-1].inactive_lanes;
    uint8_t lanes = 0;
    for (uint32_t i = 0; i < LANES && (at->flags[block].used >> i & 1) != 0; i++) {
        uint32_t child = at->first_children[block] + i;
        lanes |= (uint8_t)((below[child] == flags[child].used) << i);
    }
    return lanes;
}

static void drop_marks(bvh *f) {
    context_free(f->mesh->context, f->leaf_inactive);
    f->leaf_inactive = NULL;
    for (int i = 0; i < f->level_count; i++) {
        context_free(f->mesh->context, f->levels[i].inactive_lanes);
        f->levels[i].inactive_lanes = NULL;
    }
}

static bool allocate_marks(bvh *f) {
    cscd_context *context = f->mesh->context;
    f->leaf_inactive = context_allocate(context, f->leaf_count, sizeof *f->leaf_inactive);
    bool made = f->leaf_inactive != NULL;
    for (int i = 0; made && i < f->level_count; i++) {
        bvh_level *level = &f->levels[i];
        level->inactive_lanes = context_allocate(context, level->block_count, sizeof *level->inactive_lanes);
        made = level->inactive_lanes != NULL;
    }
    if (!made) drop_marks(f);
    return made;
}

bool bvh_set_active(bvh *f, const bool *active) {
    if (active == NULL) {
        drop_marks(f);
        return true;
    }
    if (f->leaf_inactive == NULL && !allocate_marks(f)) return false;
    for (uint32_t i = 0; i < f->leaf_count; i++) f->leaf_inactive[i] = inactive_triangles(f, i, active);
    for (int level = 0; level < f->level_count; level++) {
        for (uint32_t i = 0; i < f->levels[level].block_count; i++)
            f->levels[level].inactive_lanes[i] = inactive_children(f, level, i);
    }
    return true;
}

const char *bvh_check_active(const bvh *f, const bool *active) {
    if ((f->leaf_inactive != NULL) != (active != NULL))
        return "the trees and their detector have different active sets";
    if (active == NULL) return NULL;
    for (uint32_t i = 0; i < f->leaf_count; i++) {
        if (f->leaf_inactive[i] != inactive_triangles(f, i, active))
            return "a leaf has the wrong active triangles";
    }
    for (int level = 0; level < f->level_count; level++) {
        if (f->levels[level].inactive_lanes == NULL) return "a level does not know its active blocks";
        for (uint32_t i = 0; i < f->levels[level].block_count; i++) {
            if (f->levels[level].inactive_lanes[i] != inactive_children(f, level, i))
                return "a block has the wrong active children";
        }
    }
    return NULL;
}
