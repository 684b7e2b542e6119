/* Notes which objects trees and blocks hold: obstacles, which are not compared with each other, and sets of objects, by
 * which the traversal leaves out pairs where there are rules. */
#include "runtime/bvh/bvh.h"

/* ---- trees ------------------------------------------------------------------------------------------- */

static bool holds_only(const bvh *f, const bvh_tree *tree, const cscd_object *object) {
    for (uint32_t i = 0; i < tree->leaf_count; i++) {
        const uint32_t *triangles = f->leaves[tree->first_leaf + i].triangles;
        uint32_t used = f->leaf_flags[tree->first_leaf + i].used;
        for (uint32_t lane = 0; lane < LANES && (used >> lane & 1) != 0; lane++) {
            if (triangles[lane] - object->first_triangle >= object->triangle_count) return false;
        }
    }
    return true;
}

static uint32_t object_of_tree(const bvh *f, const bvh_tree *tree) {
    const cscd_mesh *mesh = f->mesh;
    uint32_t triangle = f->leaves[tree->first_leaf].triangles[0];
    uint32_t object = cscd_mesh_vertex_object(mesh, mesh->triangles[triangle][0]);
    return holds_only(f, tree, &mesh->objects[object]) ? object : OBJECT_SEVERAL;
}

static void name_objects(bvh *f) {
    for (uint32_t i = 0; i < f->tree_count; i++) {
        bvh_tree *tree = &f->trees[i];
        if (tree->object == OBJECT_UNKNOWN) tree->object = object_of_tree(f, tree);
        f->trees_mix_objects |= tree->object == OBJECT_SEVERAL;
    }
}

/* ---- obstacles --------------------------------------------------------------------------------------- */

/* Tells by one triangle: a tree holds obstacles only, or none at all. */
static bool tree_is_obstacle(const bvh *f, uint32_t tree) {
    return triangle_of_obstacle(f->mesh, f->leaves[f->trees[tree].first_leaf].triangles[0]);
}

static uint8_t obstacle_children(const bvh *f, int level, uint32_t block) {
    const bvh_level *at = &f->levels[level], *below = at - 1;
    uint8_t obstacles = 0;
    for (uint32_t i = 0; i < LANES && (at->flags[block].used >> i & 1) != 0; i++) {
        uint32_t child = at->first_children[block] + i;
        bool all = level == f->tree_level ? tree_is_obstacle(f, child)
                                          : below->obstacle_lanes[child] == below->flags[child].used;
        obstacles |= (uint8_t)(all << i);
    }
    return obstacles;
}

static bool mark_obstacles(bvh *f) {
    if (f->mesh->obstacles == NULL) return true;
    for (int level = f->tree_level; level < f->level_count; level++) {
        bvh_level *at = &f->levels[level];
        at->obstacle_lanes = context_allocate(f->mesh->context, at->block_count, sizeof *at->obstacle_lanes);
        if (at->obstacle_lanes == NULL) return false;
        for (uint32_t block = 0; block < at->block_count; block++)
            at->obstacle_lanes[block] = obstacle_children(f, level, block);
    }
    return true;
}

bool bvh_mark_objects(bvh *f) {
    name_objects(f);
    return mark_obstacles(f);
}

/* ---- sets of objects --------------------------------------------------------------------------------- */

static object_set set_of_tree(const bvh *f, uint32_t tree, const object_set *sets) {
    uint32_t object = f->trees[tree].object;
    if (object != OBJECT_SEVERAL) return sets[object];
    object_set all = sets[0];
    for (uint32_t i = 1; i < f->mesh->object_count; i++) all = object_sets_join(&all, &sets[i]);
    return all;
}

static object_set set_of_block(const bvh_level *level, uint32_t block) {
    const object_set *children = level->child_sets + (size_t)block * LANES;
    object_set all = children[0];
    for (uint32_t i = 1; i < LANES && (level->flags[block].used >> i & 1) != 0; i++)
        all = object_sets_join(&all, &children[i]);
    return all;
}

/* From the trees up. */
static void fill_sets(bvh *f, const object_set *sets) {
    for (int index = f->tree_level; index < f->level_count; index++) {
        const bvh_level *level = &f->levels[index];
        for (uint32_t block = 0; block < level->block_count; block++) {
            for (uint32_t i = 0; i < LANES && (level->flags[block].used >> i & 1) != 0; i++) {
                uint32_t child = level->first_children[block] + i;
                level->child_sets[(size_t)block * LANES + i] =
                    index == f->tree_level ? set_of_tree(f, child, sets) : set_of_block(level - 1, child);
            }
        }
    }
}

static void drop_sets(bvh *f) {
    for (int i = f->tree_level; i < f->level_count; i++) {
        context_free(f->mesh->context, f->levels[i].child_sets);
        f->levels[i].child_sets = NULL;
    }
}

bool bvh_set_objects(bvh *f, const object_set *sets) {
    bool had_none = f->levels[f->tree_level].child_sets == NULL;
    if (sets == NULL) {
        drop_sets(f);
        return true;
    }
    for (int i = f->tree_level; had_none && i < f->level_count; i++) {
        bvh_level *level = &f->levels[i];
        size_t lanes = (size_t)level->block_count * LANES;
        level->child_sets = context_allocate(f->mesh->context, lanes, sizeof *level->child_sets);
        if (level->child_sets == NULL) {
            drop_sets(f);
            return false;
        }
    }
    fill_sets(f, sets);
    return true;
}

void bvh_free_objects(bvh *f) {
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(f->mesh->context, f->levels[i].obstacle_lanes);
        context_free(f->mesh->context, f->levels[i].child_sets);
    }
}
