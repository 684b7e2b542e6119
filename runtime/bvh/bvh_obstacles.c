/* Obstacles in the trees: parts that are not compared with each other, and blocks of such parts. */
#include "runtime/bvh/bvh.h"

/* A part holds obstacles only, or none. */
static bool part_is_passive(const bvh *f, uint32_t part) {
    return triangle_of_obstacle(f->mesh, f->leaves[f->parts[part].first_leaf].triangles[0]);
}

static uint8_t passive_children(const bvh *f, int level, uint32_t block) {
    const bvh_level *at = &f->levels[level], *below = at - 1;
    uint8_t passive = 0;
    for (uint32_t i = 0; i < LANES && (at->flags[block].used >> i & 1) != 0; i++) {
        uint32_t child = at->first_children[block] + i;
        bool all = level == f->part_level ? part_is_passive(f, child)
                                          : below->passive[child] == below->flags[child].used;
        passive |= (uint8_t)(all << i);
    }
    return passive;
}

bool bvh_mark_obstacles(bvh *f) {
    if (f->mesh->obstacles == NULL) return true;
    for (int level = f->part_level; level < f->level_count; level++) {
        bvh_level *at = &f->levels[level];
        at->passive = context_allocate(f->mesh->context, at->block_count, sizeof *at->passive);
        if (at->passive == NULL) return false;
        for (uint32_t block = 0; block < at->block_count; block++)
            at->passive[block] = passive_children(f, level, block);
    }
    return true;
}
