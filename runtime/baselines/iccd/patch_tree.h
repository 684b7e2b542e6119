/* The BVH's order of triangles, halved and halved again: the binary trees whose nodes are tested. */
#pragma once

#include "runtime/bvh/bvh.h"

/* Nodes stand in depth-first order, the trees over the BVH's trees one after another: the left child follows its
 * parent, so children come after parents. A node of height h covers the slots from a multiple of 2^h, counted
 * in its tree, to the next. */
typedef struct patch_node {
    uint32_t right;            /* index of the right child; 0 marks a leaf */
    uint32_t first, count;     /* its triangles: triangles[first .. first + count) of the tree */
    uint32_t tree, first_slot; /* in a BVH; 0 in other trees */
    uint32_t height;
} patch_node;

typedef struct patch_tree {
    patch_node *nodes;
    uint32_t node_count;
    uint32_t *triangles; /* in the order of leaves */
    uint32_t *roots;     /* per tree of the BVH */
    uint32_t root_count;
} patch_tree;

/* Nodes of this height or less are leaves: 0 (one triangle each), or 3 (those of a leaf of the BVH). *out is untouched unless
 * CSCD_OK. */
cscd_status patch_tree_build(const bvh *hierarchy, uint32_t leaf_height, patch_tree *out);
void patch_tree_free(cscd_context *context, patch_tree *tree);

static inline bool patch_is_leaf(const patch_node *node) {
    return node->right == 0;
}

/* Hides in a BVH the pairs that lie in one patch of `sealed`, which is given per node. */
void patch_tree_hide(const patch_tree *tree, const bool *sealed, bvh *hierarchy);
