/* Leaves pairs of objects, features that are not active, and components without a surface out of traversals. */
#include "runtime/bvh/bvh_parts.h"

/* ---- trees --------------------------------------------------------------------------------------------- */

static uint32_t object_of_tree(const bvh *hierarchy, const bvh_tree *tree) {
    uint32_t triangle = hierarchy->leaves[tree->first_leaf].triangles[0];
    return cscd_mesh_vertex_object(hierarchy->mesh, hierarchy->mesh->triangles[triangle][0]);
}

static void name_objects(bvh *hierarchy) {
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        bvh_tree *tree = &hierarchy->trees[i];
        if (tree->object == OBJECT_UNKNOWN) tree->object = object_of_tree(hierarchy, tree);
    }
}

/* ---- obstacles ----------------------------------------------------------------------------------------- */

static uint8_t obstacle_children(const bvh *hierarchy, int level, uint32_t block) {
    const bvh_level *at = &hierarchy->levels[level], *below = at - 1;
    uint8_t obstacles = 0;
    for (uint32_t i = 0; i < LANES && (at->flags[block].used >> i & 1) != 0; i++) {
        uint32_t child = at->first_children[block] + i;
        bool all = level == hierarchy->tree_level
                       ? hierarchy->mesh->objects[hierarchy->trees[child].object].obstacle
                       : below->obstacle_lanes[child] == below->flags[child].used;
        obstacles |= (uint8_t)(all << i);
    }
    return obstacles;
}

static bool mark_obstacles(bvh *hierarchy) {
    if (hierarchy->mesh->obstacles == NULL) return true;
    for (int level = hierarchy->tree_level; level < hierarchy->level_count; level++) {
        bvh_level *at = &hierarchy->levels[level];
        at->obstacle_lanes =
            context_allocate(hierarchy->mesh->context, at->block_count, sizeof *at->obstacle_lanes);
        if (at->obstacle_lanes == NULL) return false;
        for (uint32_t block = 0; block < at->block_count; block++)
            at->obstacle_lanes[block] = obstacle_children(hierarchy, level, block);
    }
    return true;
}

bool bvh_mark_objects(bvh *hierarchy) {
    name_objects(hierarchy);
    return mark_obstacles(hierarchy);
}

/* ---- sets of objects ----------------------------------------------------------------------------------- */

static object_set set_of_block(const bvh_level *level, uint32_t block) {
    const object_set *children = level->child_sets + (size_t)block * LANES;
    object_set all = children[0];
    for (uint32_t i = 1; i < LANES && (level->flags[block].used >> i & 1) != 0; i++)
        all = object_sets_join(&all, &children[i]);
    return all;
}

/* From the trees up. */
static void fill_sets(bvh *hierarchy, const object_set *sets) {
    for (int index = hierarchy->tree_level; index < hierarchy->level_count; index++) {
        const bvh_level *level = &hierarchy->levels[index];
        for (uint32_t block = 0; block < level->block_count; block++) {
            for (uint32_t i = 0; i < LANES && (level->flags[block].used >> i & 1) != 0; i++) {
                uint32_t child = level->first_children[block] + i;
                level->child_sets[(size_t)block * LANES + i] = index == hierarchy->tree_level
                                                                   ? sets[hierarchy->trees[child].object]
                                                                   : set_of_block(level - 1, child);
            }
        }
    }
}

static void drop_sets(bvh *hierarchy) {
    for (int i = hierarchy->tree_level; i < hierarchy->level_count; i++) {
        context_free(hierarchy->mesh->context, hierarchy->levels[i].child_sets);
        hierarchy->levels[i].child_sets = NULL;
    }
}

bool bvh_set_objects(bvh *hierarchy, const object_set *sets) {
    bool had_none = hierarchy->levels[hierarchy->tree_level].child_sets == NULL;
    if (sets == NULL) {
        drop_sets(hierarchy);
        return true;
    }
    for (int i = hierarchy->tree_level; had_none && i < hierarchy->level_count; i++) {
        bvh_level *level = &hierarchy->levels[i];
        size_t lanes = (size_t)level->block_count * LANES;
        level->child_sets = context_allocate(hierarchy->mesh->context, lanes, sizeof *level->child_sets);
        if (level->child_sets == NULL) {
            drop_sets(hierarchy);
            return false;
        }
    }
    fill_sets(hierarchy, sets);
    return true;
}

void bvh_free_objects(bvh *hierarchy) {
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(hierarchy->mesh->context, hierarchy->levels[i].obstacle_lanes);
        context_free(hierarchy->mesh->context, hierarchy->levels[i].child_sets);
    }
}

/* ---- active vertices ----------------------------------------------------------------------------------- */

/* Leaves and blocks without an active triangle are not compared with each other. */

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
    hierarchy->has_inactive = active != NULL;
    if (active == NULL) return true;
    if (hierarchy->leaf_inactive == NULL && !allocate_marks(hierarchy)) {
        hierarchy->has_inactive = false;
        return false;
    }
    for (uint32_t i = 0; i < hierarchy->leaf_count; i++)
        hierarchy->leaf_inactive[i] = inactive_triangles(hierarchy, i, active);
    for (int level = 0; level < hierarchy->level_count; level++) {
        for (uint32_t i = 0; i < hierarchy->levels[level].block_count; i++)
            hierarchy->levels[level].inactive_lanes[i] = inactive_children(hierarchy, level, i);
    }
    return true;
}

const char *bvh_check_active(const bvh *hierarchy, const bool *active) {
    if (hierarchy->has_inactive != (active != NULL) || (active != NULL && hierarchy->leaf_inactive == NULL))
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

/* ---- components without a surface ---------------------------------------------------------------------- */

static uint8_t collapsed_children(const bvh *hierarchy, int level, uint32_t block, const bool *collapsed) {
    const bvh_level *at = &hierarchy->levels[level], *below = at - 1;
    uint8_t lanes = 0;
    for (uint32_t i = 0; i < LANES && (at->flags[block].used >> i & 1) != 0; i++) {
        uint32_t child = at->first_children[block] + i;
        bool all = level == hierarchy->tree_level
                       ? collapsed[bvh_tree_component(hierarchy, &hierarchy->trees[child])]
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

static bool allocate_collapsed_marks(bvh *hierarchy) {
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
    if (!allocate_collapsed_marks(hierarchy)) return false;
    for (int level = hierarchy->tree_level; level < hierarchy->level_count; level++) {
        for (uint32_t block = 0; block < hierarchy->levels[level].block_count; block++)
            hierarchy->levels[level].collapsed_lanes[block] =
                collapsed_children(hierarchy, level, block, collapsed);
    }
    return true;
}
