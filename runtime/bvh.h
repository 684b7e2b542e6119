/* A flat binary tree of 14-DOPs over the triangles of a mesh: one subtree per region. */
#ifndef CSCD_BVH_H
#define CSCD_BVH_H

#include "runtime/kdop.h"
#include "runtime/orientation.h"
#include "src/mesh.h"

/* Nodes stand in depth-first order: the left child follows its parent, so children come after parents. */
typedef struct bvh_node {
    kdop volume;
    uint32_t right;    /* index of the right child; 0 marks a leaf */
    uint32_t triangle; /* of a leaf */
} bvh_node;

typedef struct bvh {
    bvh_node *nodes; /* 2 * triangle_count - 1, the root first; NULL before the build */
    uint32_t *marks; /* one per node: see bvh_mark */
    uint32_t node_count;
} bvh;

/* Triangles in regions 0 to count - 1, none of them empty. */
typedef struct bvh_regions {
    const uint32_t *of_triangle;
    uint32_t count;
} bvh_regions;

/* Builds the tree's shape from positions; volumes are left to bvh_refit. Top-down: regions are split from one
 * another first, then each is split at the middle of the longest of the 7 axes of its centroids' 14-DOP
 * (thesis, chapter 4.2). *out is untouched unless CSCD_OK. */
cscd_status bvh_build(const cscd_mesh *mesh, bvh_regions regions, const double *positions, bvh *out);
void bvh_free(cscd_context *context, bvh *tree);

static inline bool bvh_is_leaf(const bvh_node *node) {
    return node->right == 0;
}

/* vertex_volumes: swept 14-DOP of every vertex. Refits bottom-up. */
void bvh_refit(bvh *tree, const cscd_mesh *mesh, const kdop *vertex_volumes);

/* A mark holds a node's region and the orientations of its triangles or'ed, in the two lowest bits. Nodes of
 * several regions have BVH_SEVERAL for a region. */
void bvh_mark(bvh *tree, bvh_regions regions, const uint8_t *orientations);

/* The same for a look at the pairs that have come to be kept: earlier are the orientations before, ZERO left
 * out, and two more bits are the earlier orientations of those triangles only that are ZERO by now. */
void bvh_mark_fresh(bvh *tree, bvh_regions regions, const uint8_t *earlier, const uint8_t *orientations);

/* 1 for nodes with suspects among their triangles, 0 for others. */
void bvh_mark_suspects(bvh *tree, const bool *suspects);

enum { BVH_ORIENTATION_BITS = 2, BVH_FLAG_BITS = 4, BVH_SEVERAL = (1 << 28) - 1 };

static inline uint8_t bvh_mark_orientation(uint32_t mark) {
    return (uint8_t)(mark & 3);
}

static inline uint8_t bvh_mark_fresh_orientation(uint32_t mark) {
    return (uint8_t)(mark >> BVH_ORIENTATION_BITS & 3);
}

/* Two subtrees cannot be the first to touch when they lie in one region and all their triangles have one
 * orientation. */
static inline bool bvh_marks_cull(uint32_t a, uint32_t b) {
    return (a ^ b) >> BVH_FLAG_BITS == 0 && a >> BVH_FLAG_BITS != BVH_SEVERAL &&
           !orientations_may_touch(bvh_mark_orientation(a), bvh_mark_orientation(b));
}

/* Marked by bvh_mark_fresh: may two subtrees hold a pair of triangles that was culled and is kept now? For
 * two triangles: is it, itself? */
static inline bool bvh_marks_hold_fresh(uint32_t a, uint32_t b) {
    bool one_region = (a ^ b) >> BVH_FLAG_BITS == 0 || a >> BVH_FLAG_BITS == BVH_SEVERAL ||
                      b >> BVH_FLAG_BITS == BVH_SEVERAL;
    return one_region && ((bvh_mark_orientation(a) & bvh_mark_fresh_orientation(b)) |
                          (bvh_mark_fresh_orientation(a) & bvh_mark_orientation(b))) != 0;
}

#endif
