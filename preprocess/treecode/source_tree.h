/* A binary tree of the charged triangles, whose nodes hold neighbours. */
#pragma once

#include "preprocess/charge/charge_system.h"
#include "src/core/context.h"

enum { SOURCES_PER_LEAF = 32, SOURCE_POINTS = 3, TREE_TASKS_MOST = 128 };

/* Sources begin to end - 1. A child has a greater number than its parent. */
typedef struct source_node {
    double center[3];
    double target_radius; /* of a ball around the centroids */
    double source_radius; /* and of one around the triangles */
    double mean_radius;   /* of the triangles themselves, in the mean */
    uint32_t begin, end;
    uint32_t children[2]; /* both 0 in a leaf */
    uint32_t leaf;        /* the number of a leaf, or of the first one below */
} source_node;

/* A triangle as the tree holds it, in its order. */
typedef struct tree_source {
    double centroid[3];
    double points[SOURCE_POINTS]
                 [3]; /* the middles of its edges: a third of the charge at each has the right moments up to
                                      * degree 2 */
    double radius;    /* of a ball around the triangle, about its centroid */
    uint32_t unknown;
} tree_source;

typedef struct source_tree {
    cscd_context *context;
    const potential_source *triangles; /* of the unknowns, not ours */
    uint32_t count, node_count, leaf_count;
    uint32_t task_count, task_nodes[TREE_TASKS_MOST];   /* disjoint subtrees, which hold all sources; */
    uint32_t above_count, above_nodes[TREE_TASKS_MOST]; /* and the nodes above them */
    source_node *nodes;
    tree_source *sources;
    uint32_t *leaves; /* their nodes */
} source_tree;

/* Nodes begin to end - 1 are a node and all below. */
uint32_t subtree_end(const source_tree *tree, uint32_t node);

/* The system's sources and collocation points are used as long as the tree lives. count > 0. */
cscd_status source_tree_create(cscd_context *context, const charge_system *system, source_tree *out);
void source_tree_destroy(source_tree *tree);

static inline bool node_is_leaf(const source_node *node) {
    return node->children[0] == 0;
}

/* Are its triangles longer than they are far from each other, as in a fan or a comb? Then no part of it that is near the tree's leaves
 * is far from anything around. */
static inline bool node_is_long(const source_node *node) {
    return node->mean_radius > 2.0 * node->target_radius;
}

static inline const potential_source *triangle_of(const source_tree *tree, uint32_t source) {
    return &tree->triangles[tree->sources[source].unknown];
}
