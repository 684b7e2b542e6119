/* Marks trees of obstacles, and blocks of such trees, which are not compared with each other. */
#include "runtime/bvh/bvh.h"

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

bool bvh_mark_obstacles(bvh *f) {
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
