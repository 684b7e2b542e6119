/* A validator of the whole BVH, for asserts and tests. */
#include "runtime/bvh/bvh.h"

#include <math.h>

/* ---- order ------------------------------------------------------------------------------------------- */

/* Is at least one lane used, and none after an empty one? */
static bool is_prefix(uint32_t used) {
    return used != 0 && (used & (used + 1)) == 0;
}

static const char *check_leaf(const bvh *f, const bvh_tree *tree, uint32_t index) {
    const bvh_leaf *leaf = &f->leaves[index];
    uint32_t used = f->leaf_flags[index].used, end = tree->first_record + tree->record_count;
    bool of_obstacles = triangle_of_obstacle(f->mesh, f->leaves[tree->first_leaf].triangles[0]);
    if (!is_prefix(used)) return "the lanes of a leaf are no prefix";
    if (&f->trees[f->leaf_trees[index]] != tree) return "a leaf names another tree than its own";
    for (uint32_t lane = 0; lane < LANES; lane++) {
        bool filled = (used >> lane & 1) != 0;
        uint32_t t = leaf->triangles[lane], from = leaf->triangles[filled ? lane : 0];
        if (filled != (t != UINT32_MAX)) return "the lanes of a leaf are not those of its triangles";
        if (filled && f->slots[t] != index * LANES + lane) return "slots and leaves are not inverse";
        if (filled && triangle_of_obstacle(f->mesh, t) != of_obstacles)
            return "a tree holds obstacles and other triangles";
        if (filled && tree->object != OBJECT_SEVERAL &&
            cscd_mesh_vertex_object(f->mesh, f->mesh->triangles[t][0]) != tree->object)
            return "a tree holds triangles of another object";
        for (int i = 0; i < 3; i++) {
            uint32_t record = leaf->corners[i][lane];
            if (record < tree->first_record || record >= end) return "a corner is a record of another tree";
            if (f->record_vertices[record] != f->mesh->triangles[from][i])
                return "a corner is a record of another vertex";
        }
    }
    return NULL;
}

static const char *check_trees(const bvh *f) {
    uint32_t leaf = 0, record = 0, triangles = 0;
    for (uint32_t i = 0; i < f->tree_count; i++) {
        const bvh_tree *tree = &f->trees[i];
        if (tree->first_leaf != leaf || tree->leaf_count == 0)
            return "the leaves of a tree do not follow the last tree's";
        if (tree->first_record != record) return "the records of a tree do not follow the last tree's";
        for (; leaf < tree->first_leaf + tree->leaf_count; leaf++) {
            const char *fault = check_leaf(f, tree, leaf);
            if (fault != NULL) return fault;
            triangles += (uint32_t)__builtin_popcount(f->leaf_flags[leaf].used);
        }
        record += tree->record_count;
    }
    if (leaf != f->leaf_count || record != f->record_count) return "some leaves or records are of no tree";
    return triangles == f->mesh->triangle_count ? NULL : "the leaves do not hold every triangle once";
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
static const char *check_tree_blocks(const bvh *f, int index) {
    const bvh_level *level = &f->levels[index];
    for (uint32_t i = 0; i < f->tree_count; i++) {
        const bvh_tree *tree = &f->trees[i];
        uint32_t begin = tree->first_blocks[index];
        uint32_t end = i + 1 < f->tree_count ? f->trees[i + 1].first_blocks[index] : level->block_count;
        uint32_t first_child = index == 0 ? tree->first_leaf : tree->first_blocks[index - 1];
        if (begin >= end || end > level->block_count || level->first_children[begin] != first_child)
            return "the blocks of a tree do not lie together";
        for (uint32_t block = begin; index == 0 && block < end; block++) {
            if (f->block_trees[block] != i) return "a block names another tree than its own";
        }
    }
    return NULL;
}

static const char *check_levels(const bvh *f) {
    const char *fault = NULL;
    for (int i = 0; fault == NULL && i < f->level_count; i++) {
        uint32_t below = i == 0 ? f->leaf_count : f->levels[i - 1].block_count;
        fault = check_children(&f->levels[i], i == f->tree_level ? f->tree_count : below);
        if (fault == NULL && i < f->tree_level) fault = check_tree_blocks(f, i);
    }
    if (fault != NULL) return fault;
    if (f->levels[f->tree_level - 1].block_count != f->tree_count) return "a tree has not one root";
    return f->levels[f->level_count - 1].block_count == 1 ? NULL : "the last level has not one block";
}

/* ---- bounds ------------------------------------------------------------------------------------------ */

typedef struct bounds_range {
    double low, high;
} bounds_range;

static bounds_range range_of(const bvh *f, int level, uint32_t block, uint32_t lane, int axis) {
    const float *low = f->levels[level].bounds + (size_t)block * (size_t)f->axis_count * 2 * LANES +
                       (size_t)axis * 2 * LANES + lane;
    return (bounds_range){(double)low[0], (double)low[LANES]};
}

static bounds_range join_ranges(bounds_range a, bounds_range b) {
    return (bounds_range){fmin(a.low, b.low), fmax(a.high, b.high)};
}

static bounds_range range_of_leaf(const bvh *f, uint32_t leaf, int axis) {
    bounds_range range = {INFINITY, -INFINITY};
    for (int i = 0; i < 3 * LANES; i++) {
        const float *record = f->records[f->leaves[leaf].corners[i / LANES][i % LANES]];
        for (int e = 0; e < 2; e++) {
            const float *p = record + 4 * e;
            double value = kdop_along((double[3]){(double)p[0], (double)p[1], (double)p[2]}, axis);
            range = join_ranges(range, (bounds_range){value, value});
        }
    }
    return range;
}

static bounds_range range_of_block(const bvh *f, int level, uint32_t block, int axis) {
    bounds_range range = {INFINITY, -INFINITY};
    for (uint32_t lane = 0; lane < LANES && (f->levels[level].flags[block].used >> lane & 1) != 0; lane++)
        range = join_ranges(range, range_of(f, level, block, lane, axis));
    return range;
}

/* Returns a tree's range over the interval, in the frame of the first tree. */
static bounds_range range_of_tree(const bvh *f, uint32_t index, int axis) {
    const bvh_tree *tree = &f->trees[index], *frame = &f->trees[0];
    bounds_range own = range_of_block(f, f->tree_level - 1, index, axis), moved = {INFINITY, -INFINITY};
    for (int e = 0; e < 2; e++) {
        double between[3];
        for (int k = 0; k < 3; k++) between[k] = (tree->origin[e][k] - frame->origin[e][k]) * f->scale;
        double by = kdop_along(between, axis);
        moved = join_ranges(moved, (bounds_range){own.low + by, own.high + by});
    }
    return moved;
}

static bounds_range range_of_child(const bvh *f, int level, uint32_t child, int axis) {
    if (level == 0) return range_of_leaf(f, child, axis);
    return level == f->tree_level ? range_of_tree(f, child, axis) : range_of_block(f, level - 1, child, axis);
}

static const char *check_lane(const bvh *f, int level, uint32_t block, uint32_t lane) {
    bool used = (f->levels[level].flags[block].used >> lane & 1) != 0;
    uint32_t child = f->levels[level].first_children[block] + lane;
    for (int axis = 0; axis < f->axis_count; axis++) {
        bounds_range range = range_of(f, level, block, lane, axis);
        if (!used && !(range.low > range.high)) return "the bounds of an empty lane are not empty";
        if (!used) continue;
        bounds_range below = range_of_child(f, level, child, axis);
        if (!(range.low <= below.low && range.high >= below.high)) return "bounds do not hold what is below";
    }
    return NULL;
}

/* A single tree has no bounds on the tree level and above. */
static const char *check_bounds(const bvh *f) {
    int end = f->tree_count > 1 ? f->level_count : f->tree_level;
    for (int level = 0; level < end; level++) {
        for (uint32_t i = 0; i < f->levels[level].block_count * LANES; i++) {
            const char *fault = check_lane(f, level, i / LANES, i % LANES);
            if (fault != NULL) return fault;
        }
    }
    return NULL;
}

const char *bvh_validate(const bvh *f, bool refitted) {
    const char *fault = check_trees(f);
    if (fault == NULL) fault = check_levels(f);
    if (fault == NULL && refitted) fault = check_bounds(f);
    return fault;
}
