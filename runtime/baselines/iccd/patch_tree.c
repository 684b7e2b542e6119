/* The BVH's order of triangles, halved and halved again: the binary trees whose nodes are tested. */
#include "runtime/baselines/iccd/patch_tree.h"

#include <string.h>

enum { LEAF_HEIGHT = 3, HEIGHT_PER_LEVEL = 3, DEPTH_MAX = 64 };

/* A node still to be built, which covers the 2^height slots of a tree from `first` on. It is the right child of
 * parent. */
typedef struct pending_node {
    uint32_t first, height, parent;
} pending_node;

static uint32_t triangles_of(const bvh *hierarchy, const bvh_tree *p) {
    uint32_t last = p->first_leaf + p->leaf_count - 1;
    return (p->leaf_count - 1) * LANES + (uint32_t)__builtin_popcount(hierarchy->leaf_flags[last].used);
}

/* Trees follow each other. */
static uint32_t triangles_before(const patch_tree *tree) {
    if (tree->root_count == 0) return 0;
    const patch_node *last = &tree->nodes[tree->roots[tree->root_count - 1]];
    return last->first + last->count;
}

static void add_tree(const bvh *hierarchy, uint32_t index, uint32_t leaf_height, patch_tree *tree) {
    const bvh_tree *p = &hierarchy->trees[index];
    uint32_t count = triangles_of(hierarchy, p), before = triangles_before(tree), depth = 0, height = 0;
    pending_node stack[DEPTH_MAX];
    while ((uint64_t)1 << height < count) height++;
    tree->roots[tree->root_count++] = tree->node_count;
    stack[depth++] = (pending_node){0, height, UINT32_MAX};
    while (depth > 0) {
        pending_node at = stack[--depth];
        while (at.height > 0 && at.first + (1u << (at.height - 1)) >= count) at.height--;
        uint32_t first = before + at.first, node = tree->node_count++;
        uint32_t size = count - at.first < 1u << at.height ? count - at.first : 1u << at.height;
        if (at.parent != UINT32_MAX) tree->nodes[at.parent].right = node;
        tree->nodes[node] = (patch_node){
            .first = first, .count = size, .tree = index, .first_slot = at.first, .height = at.height};
        if (at.height <= leaf_height) {
            const bvh_leaf *l = &hierarchy->leaves[p->first_leaf + at.first / LANES];
            memcpy(tree->triangles + first, l->triangles + at.first % LANES, size * sizeof *l->triangles);
            continue;
        }
        uint32_t half = 1u << (at.height - 1);
        stack[depth++] = (pending_node){at.first + half, at.height - 1, node};
        stack[depth++] = (pending_node){at.first, at.height - 1, UINT32_MAX};
    }
}

cscd_status patch_tree_build(const bvh *hierarchy, uint32_t leaf_height, patch_tree *out) {
    cscd_context *context = hierarchy->mesh->context;
    patch_tree tree = {0};
    size_t leaves = leaf_height == 0 ? hierarchy->mesh->triangle_count : 0;
    for (uint32_t i = 0; i < hierarchy->tree_count && leaf_height > 0; i++)
        leaves += hierarchy->trees[i].leaf_count;
    tree.nodes = context_allocate(context, leaves * 2, sizeof *tree.nodes);
    tree.triangles = context_allocate(context, hierarchy->mesh->triangle_count, sizeof *tree.triangles);
    tree.roots = context_allocate(context, hierarchy->tree_count, sizeof *tree.roots);
    if (tree.nodes == NULL || tree.triangles == NULL || tree.roots == NULL) {
        patch_tree_free(context, &tree);
        return CSCD_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) add_tree(hierarchy, i, leaf_height, &tree);
    *out = tree;
    return CSCD_OK;
}

void patch_tree_free(cscd_context *context, patch_tree *tree) {
    context_free(context, tree->nodes);
    context_free(context, tree->triangles);
    context_free(context, tree->roots);
    *tree = (patch_tree){0};
}

/* Rows and columns first to first + count - 1 of an 8 x 8 square of bits. */
static uint64_t bits_of_square(uint32_t first, uint32_t count) {
    uint64_t row = (uint64_t)(((1u << count) - 1) << first), bits = 0;
    for (uint32_t i = first; i < first + count; i++) bits |= row << (8 * i);
    return bits;
}

static void hide_patch(const patch_node *node, bvh *hierarchy) {
    if (node->height <= LEAF_HEIGHT) {
        uint32_t index = hierarchy->trees[node->tree].first_leaf + node->first_slot / LANES;
        hierarchy->leaf_self_pairs[index] &= ~bits_of_square(node->first_slot % LANES, 1u << node->height);
        return;
    }
    int level = (int)(node->height - LEAF_HEIGHT - 1) / HEIGHT_PER_LEVEL;
    uint32_t unit_height = LEAF_HEIGHT + HEIGHT_PER_LEVEL * (uint32_t)level;
    uint32_t child = node->first_slot >> unit_height, count = 1u << (node->height - unit_height);
    uint32_t block = hierarchy->trees[node->tree].first_blocks[level] + child / LANES;
    hierarchy->levels[level].self_pairs[block] &= ~bits_of_square(child % LANES, count);
}

void patch_tree_hide(const patch_tree *tree, const bool *sealed, bvh *hierarchy) {
    for (uint32_t i = 0; i < tree->node_count; i++) {
        if (sealed[i]) hide_patch(&tree->nodes[i], hierarchy);
    }
}
