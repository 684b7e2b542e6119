/* A validator of the whole BVH, for asserts and tests. */
#include "runtime/bvh/bvh.h"

#include <math.h>

/* ---- order ------------------------------------------------------------------------------------------- */

/* Is at least one lane used, and none after an empty one? */
static bool is_prefix(uint32_t used) {
    return used != 0 && (used & (used + 1)) == 0;
}

static const char *check_leaf(const bvh *hierarchy, const bvh_tree *tree, uint32_t index) {
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    uint32_t used = hierarchy->leaf_flags[index].used, end = tree->first_record + tree->record_count;
    bool of_obstacles =
        triangle_of_obstacle(hierarchy->mesh, hierarchy->leaves[tree->first_leaf].triangles[0]);
    if (!is_prefix(used)) return "the lanes of a leaf are no prefix";
    if (&hierarchy->trees[hierarchy->leaf_trees[index]] != tree)
        return "a leaf names another tree than its own";
    for (uint32_t lane = 0; lane < LANES; lane++) {
        bool filled = (used >> lane & 1) != 0;
        uint32_t t = leaf->triangles[lane], from = leaf->triangles[filled ? lane : 0];
        if (filled != (t != UINT32_MAX)) return "the lanes of a leaf are not those of its triangles";
        if (filled && hierarchy->slots[t] != index * LANES + lane) return "slots and leaves are not inverse";
        if (filled && triangle_of_obstacle(hierarchy->mesh, t) != of_obstacles)
            return "a tree holds obstacles and other triangles";
        if (filled &&
            cscd_mesh_vertex_object(hierarchy->mesh, hierarchy->mesh->triangles[t][0]) != tree->object)
            return "a tree holds triangles of another object";
        for (int i = 0; i < 3; i++) {
            uint32_t record = leaf->corners[i][lane];
            if (record < tree->first_record || record >= end) return "a corner is a record of another tree";
            if (hierarchy->record_vertices[record] != hierarchy->mesh->triangles[from][i])
                return "a corner is a record of another vertex";
        }
    }
    return NULL;
}

static const char *check_trees(const bvh *hierarchy) {
    uint32_t leaf = 0, record = 0, triangles = 0;
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        const bvh_tree *tree = &hierarchy->trees[i];
        if (tree->first_leaf != leaf || tree->leaf_count == 0)
            return "the leaves of a tree do not follow the last tree's";
        if (tree->first_record != record) return "the records of a tree do not follow the last tree's";
        for (; leaf < tree->first_leaf + tree->leaf_count; leaf++) {
            const char *fault = check_leaf(hierarchy, tree, leaf);
            if (fault != NULL) return fault;
            triangles += (uint32_t)__builtin_popcount(hierarchy->leaf_flags[leaf].used);
        }
        record += tree->record_count;
    }
    if (leaf != hierarchy->leaf_count || record != hierarchy->record_count)
        return "some leaves or records are of no tree";
    return triangles == hierarchy->mesh->triangle_count ? NULL : "the leaves do not hold every triangle once";
}

/* Checks that the children of the blocks of a level follow each other without a gap, up to count. */
static const char *check_children(const bvh_level *level, uint32_t count) {
    uint32_t child = 0;
    for (uint32_t block = 0; block < level->block_count; block++) {
        if (!is_prefix(level->flags[block].used)) return "the lanes of a block are no prefix";
        if (level->first_children[block] != child) return "the children of a level do not follow each other";
        child += (uint32_t)__builtin_popcount(level->flags[block].used);
    }
    return child == count ? NULL : "a level has not every child once";
}

/* Checks that the blocks of a tree on a level lie together and hold what the tree has on the level below. */
static const char *check_tree_blocks(const bvh *hierarchy, int index) {
    const bvh_level *level = &hierarchy->levels[index];
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        const bvh_tree *tree = &hierarchy->trees[i];
        uint32_t begin = tree->first_blocks[index];
        uint32_t end =
            i + 1 < hierarchy->tree_count ? hierarchy->trees[i + 1].first_blocks[index] : level->block_count;
        uint32_t first_child = index == 0 ? tree->first_leaf : tree->first_blocks[index - 1];
        if (begin >= end || end > level->block_count || level->first_children[begin] != first_child)
            return "the blocks of a tree do not lie together";
        for (uint32_t block = begin; index == 0 && block < end; block++) {
            if (hierarchy->block_trees[block] != i) return "a block names another tree than its own";
        }
    }
    return NULL;
}

static const char *check_levels(const bvh *hierarchy) {
    const char *fault = NULL;
    for (int i = 0; fault == NULL && i < hierarchy->level_count; i++) {
        uint32_t below = i == 0 ? hierarchy->leaf_count : hierarchy->levels[i - 1].block_count;
        fault =
            check_children(&hierarchy->levels[i], i == hierarchy->tree_level ? hierarchy->tree_count : below);
        if (fault == NULL && i < hierarchy->tree_level) fault = check_tree_blocks(hierarchy, i);
    }
    if (fault != NULL) return fault;
    if (hierarchy->levels[hierarchy->tree_level - 1].block_count != hierarchy->tree_count)
        return "a tree has not one root";
    return hierarchy->levels[hierarchy->level_count - 1].block_count == 1
               ? NULL
               : "the last level has not one block";
}

/* ---- bounds ------------------------------------------------------------------------------------------ */

typedef struct bounds_range {
    double low, high;
} bounds_range;

static bounds_range range_of(const bvh *hierarchy, int level, uint32_t block, uint32_t lane, int axis) {
    const float *low = hierarchy->levels[level].bounds +
                       (size_t)block * (size_t)hierarchy->axis_count * 2 * LANES + (size_t)axis * 2 * LANES +
                       lane;
    return (bounds_range){(double)low[0], (double)low[LANES]};
}

static bounds_range join_ranges(bounds_range a, bounds_range b) {
    return (bounds_range){fmin(a.low, b.low), fmax(a.high, b.high)};
}

static bounds_range range_of_leaf(const bvh *hierarchy, uint32_t leaf, int axis) {
    bounds_range range = {INFINITY, -INFINITY};
    for (int i = 0; i < 3 * LANES; i++) {
        const float *record = hierarchy->records[hierarchy->leaves[leaf].corners[i / LANES][i % LANES]];
        for (int e = 0; e < 2; e++) {
            const float *p = record + 4 * e;
            double value = kdop_along((double[3]){(double)p[0], (double)p[1], (double)p[2]}, axis);
            range = join_ranges(range, (bounds_range){value, value});
        }
    }
    return range;
}

static bounds_range range_of_block(const bvh *hierarchy, int level, uint32_t block, int axis) {
    bounds_range range = {INFINITY, -INFINITY};
    for (uint32_t lane = 0; lane < LANES && (hierarchy->levels[level].flags[block].used >> lane & 1) != 0;
         lane++)
        range = join_ranges(range, range_of(hierarchy, level, block, lane, axis));
    return range;
}

/* Returns a tree's range over the interval, in the frame of the first tree. */
static bounds_range range_of_tree(const bvh *hierarchy, uint32_t index, int axis) {
    const bvh_tree *tree = &hierarchy->trees[index], *frame = &hierarchy->trees[0];
    bounds_range own = range_of_block(hierarchy, hierarchy->tree_level - 1, index, axis),
                 moved = {INFINITY, -INFINITY};
    for (int e = 0; e < 2; e++) {
        double between[3];
        for (int k = 0; k < 3; k++)
            between[k] = (tree->origin[e][k] - frame->origin[e][k]) * hierarchy->scale;
        double by = kdop_along(between, axis);
        moved = join_ranges(moved, (bounds_range){own.low + by, own.high + by});
    }
    return moved;
}

static bounds_range range_of_child(const bvh *hierarchy, int level, uint32_t child, int axis) {
    if (level == 0) return range_of_leaf(hierarchy, child, axis);
    return level == hierarchy->tree_level ? range_of_tree(hierarchy, child, axis)
                                          : range_of_block(hierarchy, level - 1, child, axis);
}

static const char *check_lane(const bvh *hierarchy, int level, uint32_t block, uint32_t lane) {
    bool used = (hierarchy->levels[level].flags[block].used >> lane & 1) != 0;
    uint32_t child = hierarchy->levels[level].first_children[block] + lane;
    for (int axis = 0; axis < hierarchy->axis_count; axis++) {
        bounds_range range = range_of(hierarchy, level, block, lane, axis);
        if (!used && !(range.low > range.high)) return "the bounds of an empty lane are not empty";
        if (!used) continue;
        bounds_range below = range_of_child(hierarchy, level, child, axis);
        if (!(range.low <= below.low && range.high >= below.high)) return "bounds do not hold what is below";
    }
    return NULL;
}

/* A single tree has no bounds on the tree level and above. */
static const char *check_bounds(const bvh *hierarchy) {
    int end = hierarchy->tree_count > 1 ? hierarchy->level_count : hierarchy->tree_level;
    for (int level = 0; level < end; level++) {
        for (uint32_t i = 0; i < hierarchy->levels[level].block_count * LANES; i++) {
            const char *fault = check_lane(hierarchy, level, i / LANES, i % LANES);
            if (fault != NULL) return fault;
        }
    }
    return NULL;
}

const char *bvh_validate(const bvh *hierarchy, bool refitted) {
    const char *fault = check_trees(hierarchy);
    if (fault == NULL) fault = check_levels(hierarchy);
    if (fault == NULL && refitted) fault = check_bounds(hierarchy);
    return fault;
}
