/* Patches that cannot touch themselves: ICCD (Tang et al. 2009), by normal cones and contour tests. */
#pragma once

#include "runtime/baselines/iccd/contour.h"
#include "runtime/baselines/iccd/normal_cone.h"
#include "runtime/baselines/iccd/patch_tree.h"

/* A patch is the set of triangles below a node. Contours are fixed, the rest belongs to the current interval. */
typedef struct patches {
    patch_tree tree;
    size_t *contour_offsets; /* the contour of node i: contour_edges[offsets[i] .. offsets[i + 1]) */
    uint32_t *contour_edges; /* edges with one triangle in the patch; first those of the parent's contour, */
    uint32_t *inherited;     /* per node so many */
    bool *disks;             /* per node: connected, oriented, and its contour is one loop */
    normal_cone *cones;
    contour_edge *scratch;        /* longest for each thread */
    size_t longest;               /* contour */
    uint32_t *stack;              /* large nodes that wait for their turn */
    uint32_t *small_roots;        /* the largest small subtrees, in the order of nodes, */
    uint32_t small_count;         /* so many, */
    uint32_t *small_ends;         /* and one past the last node of each */
    bool *parent_tested, *passed; /* per node, in the current interval; no node below one that passed */
    bool *tested, *reached;       /* its contour was; no node above it has passed */
    uint64_t contours, sealed;    /* tests made, patches that passed */
} patches;

/* The patches of a BVH that is built; makes room in it for hidden pairs. Bounds do not matter. On failure *out is
 * untouched. */
cscd_status patches_create(const cscd_mesh *mesh, bvh *f, patches *out);
void patches_free(cscd_context *context, patches *p);

/* Finds the nodes whose triangles cannot touch each other while the vertices move from x0 to x1, and hides
 * their pairs in the BVH. See docs/theory/iccd.md for the proof.
 * published: as in the literature, which loses contacts: cones hold the normals of both ends only and may
 * open up to pi, any set of triangles is a patch, contours are taken to be simple at the start, and pairs of
 * edges that the parent's contour has too are not tested again although the axis is another. */
void patches_seal(patches *p, const cscd_mesh *mesh, bvh *f, const double *x0, const double *x1,
                  bool published);
