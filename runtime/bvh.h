/* A flat binary tree of 14-DOPs over the triangles of a mesh: one subtree per component. */
#ifndef CSCD_BVH_H
#define CSCD_BVH_H

#include "runtime/kdop.h"
#include "src/mesh.h"

/* Nodes stand in depth-first order: the left child follows its parent, so children come after parents. */
typedef struct bvh_node {
    kdop volume;
    uint32_t right;    /* index of the right child; 0 marks a leaf */
    uint32_t triangle; /* of a leaf */
} bvh_node;

typedef struct bvh {
    bvh_node *nodes; /* 2 * triangle_count - 1, the root first; NULL before the build */
    uint32_t node_count;
} bvh;

/* Builds the tree's shape from positions; volumes are left to bvh_refit. Top-down: components are split from
 * one another first, then each is split at the middle of the longest of the 7 axes of its centroids' 14-DOP
 * (thesis, chapter 4.2). *out is untouched unless CSCD_OK. */
cscd_status bvh_build(const cscd_mesh *mesh, const double *positions, bvh *out);
void bvh_free(cscd_context *context, bvh *tree);

static inline bool bvh_is_leaf(const bvh_node *node) {
    return node->right == 0;
}

/* vertex_volumes: swept 14-DOP of every vertex. Refits bottom-up. */
void bvh_refit(bvh *tree, const cscd_mesh *mesh, const kdop *vertex_volumes);

#endif
