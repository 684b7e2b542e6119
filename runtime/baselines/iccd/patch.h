/* Patches that cannot touch themselves, by normal cones and contour tests: those of ICCD (Tang et al. 2009), and others. */
#pragma once

#include "runtime/baselines/iccd/contour.h"
#include "runtime/baselines/iccd/normal_cone.h"
#include "runtime/baselines/iccd/patch_tree.h"

/* One thread tests a whole subtree of at most 2^SMALL_HEIGHT triangles; nodes above are tested level by level. */
enum { SMALL_HEIGHT = 6 };

/* A patch is the set of triangles below a node. Contours are fixed, the rest belongs to the current interval. */
typedef struct patches {
    patch_tree tree;
    size_t *contour_offsets; /* the contour of node i: contour_edges[offsets[i] .. offsets[i + 1]) */
    uint32_t *contour_edges; /* edges with one triangle in the patch, those of the parent's contour first */
    uint32_t
        *loops; /* in their place: the vertices of a disk's contour in order, with the patch on the left */
    uint32_t *inherited; /* per node: how many edges its parent's contour has, too */
    bool *disks;         /* per node: connected, oriented, and its contour is one loop */
    normal_cone *cones;
    uint32_t *by_height; /* nodes, leaves first */
    uint32_t *height_begins,
        height_count; /* where those of each height begin there (leaves: 0), and the end */
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
 * docs/theory/iccd.md for the proof, and docs/theory/cones.md.
 * published: follows the literature, which loses contacts. Cones hold the normals of both ends only and may open up
 * to pi, any set of triangles is a patch, contours are assumed to be simple at the start, and pairs of edges that
 * the parent's contour has too are not tested again although the axis is another. */
void patches_seal(patches *p, const cscd_mesh *mesh, const double *x0, const double *x1, bool published);
