/* Triangles near a box at one moment, by the trees. */
#include "runtime/bvh/bvh_parts.h"

#include <math.h>

/* In doubles a coordinate in a frame is off by 2^-51 of the larger of its two terms; bounds have a slack for that, and the
 * float's 2^-23 covers the rest. */
static framed_query frame_box(const bvh *hierarchy, const bvh_tree *tree, const query_box *box) {
    framed_query q;
    for (int k = 0; k < 3; k++) {
        double low = (box->low[k] - tree->origin[0][k]) * hierarchy->scale;
        double high = (box->high[k] - tree->origin[0][k]) * hierarchy->scale;
        double rounding = (fabs(tree->origin[0][k]) * hierarchy->scale) * 0x1p-50;
        q.low[k] = (float)(low - fabs(low) * 0x1p-22 - rounding - 0x1p-120);
        q.high[k] = (float)(high + fabs(high) * 0x1p-22 + rounding + 0x1p-120);
    }
    return q;
}

static uint32_t children_in_box(const bvh *hierarchy, int level, uint32_t block, const framed_query *q) {
    const float *bounds =
        hierarchy->levels[level].bounds + (size_t)block * (size_t)hierarchy->axis_count * 2 * LANES;
    uint32_t apart[LANES] = {0}, lanes = 0;
    for (int k = 0; k < BOX_AXES; k++) {
        const float *lows = bounds + 2 * k * LANES, *highs = lows + LANES;
        for (uint32_t lane = 0; lane < LANES; lane++)
            apart[lane] |= (uint32_t)(lows[lane] > q->high[k]) | (uint32_t)(highs[lane] < q->low[k]);
    }
    for (uint32_t lane = 0; lane < LANES; lane++) lanes |= (apart[lane] ^ 1u) << lane;
    return lanes & hierarchy->levels[level].flags[block].used;
}

/* Is the triangle's box apart from the query? The slack of its tree covers the rounding of its records. */
static bool triangle_is_apart(const bvh *hierarchy, const bvh_tree *tree, const bvh_leaf *leaf, uint32_t lane,
                              const framed_query *q) {
    const float *a = hierarchy->records[leaf->corners[0][lane]],
                *b = hierarchy->records[leaf->corners[1][lane]];
    const float *c = hierarchy->records[leaf->corners[2][lane]];
    for (int k = 0; k < BOX_AXES; k++) {
        float low = q->low[k] - tree->slack[0], high = q->high[k] + tree->slack[0];
        if ((a[k] > high && b[k] > high && c[k] > high) || (a[k] < low && b[k] < low && c[k] < low))
            return true;
    }
    return false;
}

static void visit_leaf(const bvh *hierarchy, const bvh_tree *tree, uint32_t index, const framed_query *q,
                       void (*visit)(void *data, uint32_t triangle), void *data) {
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    for (uint32_t used = hierarchy->leaf_flags[index].used, lane = 0; (used >> lane & 1) != 0; lane++) {
        if (!triangle_is_apart(hierarchy, tree, leaf, lane, q)) visit(data, leaf->triangles[lane]);
    }
}

typedef struct query_place {
    int level;
    uint32_t block;
} query_place;

/* Each block takes one place and leaves eight, and there are no more levels than this. */
enum { QUERY_STACK = BVH_LEVEL_MAX * LANES };

static bool tree_is_open(const bvh *hierarchy, const bvh_tree *tree) {
    return !hierarchy->mesh->components[bvh_tree_component(hierarchy, tree)].closed_manifold;
}

void bvh_visit_box(const bvh *hierarchy, const query_box *box, bool closed_only,
                   void (*visit)(void *data, uint32_t triangle), void *data) {
    if (hierarchy->tree_count == 0) return; /* and of one tree, nothing above it has bounds */
    query_place stack[QUERY_STACK];
    int count = 0;
    framed_query above = frame_box(hierarchy, &hierarchy->trees[0], box), q = above;
    const bvh_tree *tree = &hierarchy->trees[0];
    stack[count++] =
        (query_place){hierarchy->tree_count == 1 ? hierarchy->tree_level - 1 : hierarchy->level_count - 1, 0};
    while (count > 0) {
        query_place at = stack[--count];
        if (at.level == hierarchy->tree_level - 1) { /* a tree begins, with a frame of its own */
            tree = &hierarchy->trees[at.block];
            if (closed_only && tree_is_open(hierarchy, tree)) continue;
            q = frame_box(hierarchy, tree, box);
        }
        uint32_t first = hierarchy->levels[at.level].first_children[at.block];
        const framed_query *here = at.level >= hierarchy->tree_level ? &above : &q;
        for (uint32_t near = children_in_box(hierarchy, at.level, at.block, here); near != 0;
             near &= near - 1) {
            uint32_t child = first + (uint32_t)__builtin_ctz(near);
            if (at.level == 0)
                visit_leaf(hierarchy, tree, child, &q, visit, data);
            else
                stack[count++] = (query_place){at.level - 1, child};
        }
    }
}

/* ---- nearest ------------------------------------------------------------------------------------------- */

typedef struct near_place {
    double squared; /* no triangle below is nearer */
    int level;
    uint32_t block;
} near_place;

static double round_down(float squared) {
    return (double)squared * (1.0 - 0x1p-20);
}

/* Puts the children that may be near on the stack, the nearest one last. */
static int push_children(const bvh *hierarchy, const near_place *at, const framed_query *q, double squared,
                         near_place *stack, int count) {
    float distances[LANES];
    uint32_t first = hierarchy->levels[at->level].first_children[at->block];
    uint32_t used = hierarchy->levels[at->level].flags[at->block].used;
    int begin = count;
    hierarchy->kernels->near_children(hierarchy->levels[at->level].bounds +
                                          (size_t)at->block * (size_t)hierarchy->axis_count * 2 * LANES,
                                      q, distances);
    for (uint32_t lane = 0; (used >> lane & 1) != 0; lane++) {
        const double distance = round_down(distances[lane]);
        if (distance > squared) continue;
        int i = count++;
        for (; i > begin && stack[i - 1].squared < distance; i--) stack[i] = stack[i - 1];
        stack[i] = (near_place){distance, at->level - 1, first + lane};
    }
    return count;
}

static bool tree_is_asked_for(const bvh *hierarchy, const bvh_tree *tree, const near_quest *quest) {
    if (tree->object != quest->object) return false;
    return quest->numbers == NULL || quest->numbers[bvh_tree_component(hierarchy, tree)] == quest->number;
}

static void visit_near_leaf(const bvh *hierarchy, const bvh_tree *tree, uint32_t index, const framed_query *q,
                            const double *squared, void (*visit)(void *data, uint32_t triangle), void *data) {
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    uint32_t near = hierarchy->kernels->near_triangles(hierarchy, tree, leaf, q, *squared) &
                    hierarchy->leaf_flags[index].used;
    for (; near != 0; near &= near - 1) visit(data, leaf->triangles[__builtin_ctz(near)]);
}

void bvh_visit_near(const bvh *hierarchy, const near_quest *quest, const double point[3], double *squared,
                    void (*visit)(void *data, uint32_t triangle), void *data) {
    if (hierarchy->tree_count == 0) return;
    const query_box box = {{point[0], point[1], point[2]}, {point[0], point[1], point[2]}};
    near_place stack[QUERY_STACK];
    int count = 0;
    framed_query above = frame_box(hierarchy, &hierarchy->trees[0], &box), q = above;
    const bvh_tree *tree = &hierarchy->trees[0];
    stack[count++] = (near_place){
        0.0, hierarchy->tree_count == 1 ? hierarchy->tree_level - 1 : hierarchy->level_count - 1, 0};
    while (count > 0) {
        near_place at = stack[--count];
        if (at.squared > *squared) continue;
        if (at.level == hierarchy->tree_level - 1) {
            tree = &hierarchy->trees[at.block];
            if (!tree_is_asked_for(hierarchy, tree, quest)) continue;
            q = frame_box(hierarchy, tree, &box);
        }
        if (at.level >= 0) {
            count = push_children(hierarchy, &at, at.level >= hierarchy->tree_level ? &above : &q, *squared,
                                  stack, count);
            continue;
        }
        visit_near_leaf(hierarchy, tree, at.block, &q, squared, visit, data);
    }
}
