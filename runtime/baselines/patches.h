/* Patches that cannot touch themselves, by normal cones and contour tests: those of ICCD (Tang et al. 2009), and others. */
#pragma once

#include "runtime/bvh/bvh.h"

/* ---- normal cones ------------------------------------------------------------------------------------------ */

/* A cone of directions that holds every normal of a set of triangles during a whole interval (Provot 1997; Tang et al. 2009). An
 * angle of INFINITY says that there is no cone. Axes have length 1 up to rounding, for which angles allow. */
typedef struct normal_cone {
    float axis[3], angle; /* half the opening, in radians */
} normal_cone;

/* Cones of less than this have all their normals on one side of the plane across the axis, also when the axis
 * is off by 1e-4. */
static const float normal_cone_limit = 1.5706f;

static inline bool normal_cone_exists(const normal_cone *cone) {
    return cone->angle < normal_cone_limit;
}

typedef struct normal_cone_kernels {
    /* The cones of eight triangles, whose corners move linearly. A normal, the cross product of two edges, is quadratic
     * in time: its cone holds all three Bernstein vectors and with them every normal between. published: it holds the
     * normals at the two ends only, so normals between may lie outside, and it may be wider than the limit. */
    void (*of_triangles)(const uint32_t (*triangles)[3], const uint32_t which[LANES], const double *x0,
                         const double *x1, bool published, normal_cone out[LANES]);

    /* A cone of all eight, as of_triangles with published = false. */
    void (*of_eight)(const uint32_t (*triangles)[3], const uint32_t which[LANES], const double *x0,
                     const double *x1, normal_cone *out);

    /* The cones that each hold two of those given (thesis, equations 5.1 and 5.2); there is none where it would be wider
     * than the limit. */
    void (*of_unions)(const normal_cone *cones, const uint32_t a[LANES], const uint32_t b[LANES], float limit,
                      normal_cone out[LANES]);
} normal_cone_kernels;

DECLARE_KERNELS(normal_cone_kernels);

static inline const normal_cone_kernels *normal_cone_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, normal_cone_kernels);
}

/* ---- contour tests ----------------------------------------------------------------------------------------- */

/* An edge of a contour, projected: ends a and b, at both ends of the interval. */
typedef struct contour_edge {
    double a[2][2], b[2][2]; /* [time][axis] */
    double low[2], high[2];  /* the box that it stays in, rounding included */
    uint32_t vertices[2];
} contour_edge;

/* The place where an edge's box begins, for sorting. */
typedef struct contour_key {
    double low;
    uint32_t edge; /* in the list of edges */
} contour_key;

/* A contour and its motion. */
typedef struct contour_query {
    const cscd_mesh *mesh;
    const uint32_t *edges; /* of the mesh; or NULL */
    const uint32_t *loop;  /* or its vertices in order, with the surface on their left */
    uint32_t edge_count;
    const double *x0, *x1;
    const float *axis; /* along which the contour is projected, of about unit length */
    uint32_t skipped;  /* pairs among the first `skipped` edges count as tested already */
    bool published;    /* only motions are tested, not the start */
} contour_query;

/* A way to test contours that are one loop. */
typedef struct contour_test {
    bool by_loops;        /* it takes the vertices in order, else the edges */
    uint32_t leaf_height; /* of the trees whose nodes it tests: see patch_tree_build */
    size_t scratch_size;  /* bytes per edge */
    bool (*passes)(const contour_query *query, void *scratch);
} contour_test;

/* The test of ICCD, by contour_stays_simple. */
extern const contour_test sweep_test;

/* Certified for edges that form one loop: true only if no two of them touch in the projection at any moment of the
 * interval, except neighbours at their common vertices. For a loop of three edges it tests nothing, because such a
 * loop is simple as long as its projection has an area. edges, keys: room for edge_count of them. */
bool contour_stays_simple(const contour_query *query, contour_edge *edges, contour_key *keys);

/* A vertex of a contour, projected, at both ends of the interval. */
typedef struct star_vertex {
    double at[2][2]; /* [time][axis], from the middle */
    uint32_t kept;   /* of the i-th vertex: which one is the i-th that no ear has cut off */
} star_vertex;

/* Certified for the loop of a disk whose triangles all face the axis: true only if the projection of the disk is one-to-one at every
 * moment of the interval (docs/theory/iccd.md). Linear in the loop's length. vertices: room for edge_count of them. */
bool contour_stays_star(const contour_query *query, star_vertex *vertices);

/* The test of cones, by contour_stays_star. */
extern const contour_test star_test;

/* ---- trees of patches -------------------------------------------------------------------------------------- */

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

/* ---- patches ----------------------------------------------------------------------------------------------- */

/* One thread tests a whole subtree of at most 2^SMALL_HEIGHT triangles; nodes above are tested level by level. */
enum { SMALL_HEIGHT = 6 };

/* A patch is the set of triangles below a node. Contours are fixed, the rest belongs to the current interval. */
typedef struct patches {
    patch_tree tree;
    size_t *contour_offsets; /* the contour of node i: contour_edges[offsets[i] .. offsets[i + 1]) */
    uint32_t *contour_edges; /* edges with one triangle in the patch, those of the parent's contour first */

    /* In the place of its edges: the vertices of a disk's contour in order, with the patch on the left. */
    uint32_t *loops;

    uint32_t *inherited; /* per node: how many edges its parent's contour has, too */
    bool *disks;         /* per node: connected, oriented, and its contour is one loop */
    normal_cone *cones;
    uint32_t *by_height; /* nodes, leaves first */

    /* The places in by_height where the nodes of each height begin (leaves: 0), and the end. */
    uint32_t *height_begins, height_count;

    const contour_test *test;
    void *scratch;                /* of the test, for `longest` edges for each thread */
    size_t longest;               /* the most edges of a contour */
    uint32_t *stack;              /* large nodes that wait for their turn */
    uint32_t *small_roots;        /* roots of the largest small subtrees, in the order of nodes */
    uint32_t small_count;         /* the number of these subtrees */
    uint32_t *small_ends;         /* one past the last node of each of them */
    bool *parent_tested, *passed; /* per node, in the current interval; never set below a node that passed */
    bool *tested, *reached;       /* per node: its contour was tested; no node above it has passed */
    uint64_t contours, sealed;    /* contour tests that were made; patches that passed */
} patches;

/* Makes the patches of a tree, which it takes over, and frees on failure, when *out is untouched. */
cscd_status patches_create(const cscd_mesh *mesh, const patch_tree *tree, const contour_test *test,
                           patches *out);
void patches_free(cscd_context *context, patches *p);

/* Finds the nodes whose triangles cannot touch each other while the vertices move from x0 to x1: they have passed. See
 * docs/theory/iccd.md for the proofs.
 * published: follows the literature, which loses contacts. Cones hold the normals of both ends only and may open up
 * to pi, any set of triangles is a patch, contours are assumed to be simple at the start, and pairs of edges that
 * the parent's contour has too are not tested again although the axis is another. */
void patches_seal(patches *p, const cscd_mesh *mesh, const double *x0, const double *x1, bool published);
