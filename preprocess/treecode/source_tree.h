/* The treecode from its sources up: the tree, which nodes act on which others, blocks of low rank, evaluation, and a preconditioner. */
#pragma once

#include "preprocess/charge/charge.h"
#include "preprocess/treecode/expansion.h"
#include "src/core/kernels.h"

/* ---- the tree ------------------------------------------------------------------------------------------ */

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

/* ---- interactions -------------------------------------------------------------------------------------- */

/* Interactions list the pairs of nodes that act by expansions, and the sources that act one by one on the
 * targets of a leaf. */

/* A source node and the order of the expansion, which are the low 28 and the high 4 bits. */
typedef uint32_t far_item;

enum { FAR_NODE_BITS = 28 };

typedef struct interactions {
    cscd_context *context;
    size_t node_count, leaf_count, far_count, near_count, long_count;
    size_t *far_begins; /* node n has far_items[far_begins[n] .. far_begins[n + 1]), by order */
    far_item *far_items;
    /* Leaf l has near_sources[near_begins[2 l] .. near_begins[2 l + 2]); those from near_begins[2 l + 1] on are far enough for
     * points to stand for them. */
    size_t *near_begins;
    uint32_t *near_sources;
    size_t *long_begins; /* node n has long_sources[long_begins[n] .. long_begins[n + 1]): see rank_block */
    uint32_t *long_sources;
} interactions;

/* Every pair of a source and a target is in one item of one ancestor of the target, far or long, or in one near list. An expansion's error is
 * at most 1 % of the potential that its sources would have if all their charges were positive: with the two balls' radii over the
 * distance of their centres, t, it is t^(p+1) (1 + t) / (1 - t) for order p (the terms of 1 / r in Legendre polynomials). */
cscd_status interactions_create(const source_tree *tree, interactions *out);
void interactions_destroy(interactions *lists);

/* ---- blocks of low rank -------------------------------------------------------------------------------- */

/* The action of long triangles on targets that are far from their centroids, but not from the triangles: the
 * potentials of two such nodes vary smoothly from triangle to triangle, so few columns of their block give
 * all others (an interpolative decomposition: Cheng, Gimbutas, Martinsson, Rokhlin 2005). Without, every fan
 * of n triangles would have n^2 near pairs. */

/* numbers[begin ..]: `rank` columns of the targets' potentials, and as many rows of weights, one for each source; with rank 0 the
 * potentials of all sources. Each is of a charge of 1. */
typedef struct rank_block {
    uint32_t target, source; /* nodes */
    uint32_t rank;
    size_t begin;
} rank_block;

/* The blocks whose targets are in one task's subtree. */
typedef struct rank_list {
    rank_block *blocks;
    float *numbers;
    size_t block_count, block_room, number_count, number_room;
} rank_list;

typedef struct rank_blocks {
    cscd_context *context; /* NULL: there is nothing to be freed */
    rank_list lists[TREE_TASKS_MOST];
} rank_blocks;

/* The bytes that the blocks of these interactions will usually take, with what finding them takes. */
double rank_blocks_expected_bytes(const source_tree *tree, const interactions *lists);

/* The bytes that they take. */
double rank_blocks_bytes(const rank_blocks *blocks);

/* Finds the blocks. A block whose potentials are not smooth is parted further, and at last all its potentials
 * are kept. */
cscd_status rank_blocks_create(const source_tree *tree, const interactions *lists, rank_blocks *out);
void rank_blocks_destroy(rank_blocks *blocks);

/* Adds the potentials of a task's blocks; both in the tree's order. The same bits on every processor. */
void rank_blocks_add(const source_tree *tree, const rank_blocks *blocks, uint32_t task, const double *charges,
                     double *potentials);

/* ---- kernels ------------------------------------------------------------------------------------------- */

/* A node's far items; moments of all nodes, HARMONIC_COUNT each. */
typedef struct far_field {
    const expansion_tables *tables;
    const source_node *nodes;
    const double *moments;
    const far_item *items;
    size_t item_count;
} far_field;

enum { LEAF_VECTORS = SOURCES_PER_LEAF / LANES };

/* A leaf's targets, from its center, and what is near them. Those that fill up the last vector repeat a target. */
typedef struct near_field {
    float x[SOURCES_PER_LEAF], y[SOURCES_PER_LEAF], z[SOURCES_PER_LEAF];
    uint32_t vector_count;
    const double *center;
    const tree_source *sources;
    const double *charges; /* of all sources */
    const uint32_t *exact, *points;
    size_t exact_count, point_count;
    const float *potentials; /* of a charge of 1 on an exact source: vector_count * LANES of each */
} near_field;

typedef struct treecode_kernels {
    /* Adds the potential of the far items, as coefficients about the center of a node. */
    void (*add_far_field)(const far_field *field, const double center[3],
                          double coefficients[HARMONIC_COUNT]);

    /* Writes the potential of what is near. */
    void (*near_potential)(const near_field *field, double potentials[SOURCES_PER_LEAF]);
} treecode_kernels;

DECLARE_KERNELS(treecode_kernels);

/* ---- evaluation ---------------------------------------------------------------------------------------- */

/* The potential of the charges of a component at all its collocation points, in time n log n: a treecode with expansions about
 * sources and targets (Greengard, Rokhlin 1987). */

typedef struct treecode {
    cscd_context *context;
    source_tree tree;
    interactions lists;
    rank_blocks ranks; /* made by treecode_fill */
    expansion_tables tables;
    const treecode_kernels *kernels;
    double *moments, *coefficients; /* of all nodes, HARMONIC_COUNT each */
    size_t *
        exact_begins; /* leaf l has exact_potentials[exact_begins[l] .. exact_begins[l + 1]), see near_field */
    float *exact_potentials;
    size_t exact_count;
} treecode;

/* Makes the tree and its lists. The system is used as long as the treecode lives. */
cscd_status treecode_create(cscd_context *context, const charge_system *system, treecode *out);
void treecode_destroy(treecode *t);

/* Returns the bytes that it takes once it is filled, which depends on the sizes of triangles and their
 * neighbours. */
double treecode_bytes(const treecode *t);

/* Finds the potentials of sources that are near, which is done once, before all evaluations. */
cscd_status treecode_fill(treecode *t);

/* Writes the potentials at the collocation points, in the order of the tree, as are the charges. The error of each is at most 1 % of
 * the potential that far charges would have if all were positive; 1e-5 of it is usual. The same bits for any number of threads and on
 * every processor. */
cscd_status treecode_evaluate(treecode *t, const double *charges, double *potentials);

/* ---- the preconditioner -------------------------------------------------------------------------------- */

/* The preconditioner: charges of a leaf's triangles from the potentials there and around, as if nothing else were charged. */

typedef struct near_blocks {
    const treecode *t;
    size_t *begins; /* leaf l has the block members[begins[l] .. begins[l + 1]), its own sources first */
    size_t *
        row_begins; /* and rows[row_begins[l] ..], the inverse's rows of its own sources by columns of the block */
    uint32_t *members; /* places in the tree's order */
    float *rows;
    size_t member_count, row_count;
} near_blocks;

/* The bytes that the blocks of a treecode take while they are made. */
double near_blocks_bytes(const treecode *t);

/* The treecode is used as long as the blocks live. */
cscd_status near_blocks_create(const treecode *t, near_blocks *out);
void near_blocks_destroy(near_blocks *blocks);

/* Writes charges that have about these potentials; both in the tree's order. */
void near_blocks_apply(const near_blocks *blocks, const double *potentials, double *charges);
