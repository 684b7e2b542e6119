/* The kernels of the BVH. */
#pragma once

#include "src/core/context.h"
#include "src/core/kernels.h"

struct bvh;
struct bvh_leaf;
struct bvh_skin;
struct bvh_tree;
struct framed_query;
struct orientation_lasting;
struct traversal;
struct traversal_lane;

/* Summary of the copied records: the largest magnitude of a coordinate, and the weighted sums of the coordinates at
 * the start and at the end. */
typedef struct copied {
    double reach, weighted[2][3];
} copied;

/* Sums of extents along the axes, over all leaves and over all triangles. */
typedef struct extents {
    double leaves, triangles;
} extents;

typedef struct bvh_kernels {
    /* Fills records begin to end - 1, multiples of 8, of a tree; see runtime/bvh/bvh.h. */
    void (*copy_in)(const struct bvh *hierarchy, const struct bvh_tree *tree, uint32_t begin, uint32_t end,
                    const double *x0, const double *x1, copied *out);

    /* Computes the bounds of the children of blocks begin to end - 1 of any level but the tree level. */
    void (*refit)(const struct bvh *hierarchy, int level, uint32_t begin, uint32_t end);

    /* Sums the extents of all leaves, and those of all triangles, at the start. */
    extents (*extents_at_start)(const struct bvh *hierarchy);

    /* Writes the flags of leaves begin to end - 1 of a tree, and the orientations of their triangles. clean has an
     * element per triangle of the mesh, and triangles that are not clean become ZERO; NULL: all are clean. */
    void (*orient)(const struct bvh *hierarchy, const struct bvh_tree *tree, uint32_t begin, uint32_t end,
                   const bool *clean, uint8_t *orientations);

    /* The same for orientations that last: see orientation_query. */
    void (*orient_lasting)(const struct bvh *hierarchy, const struct bvh_tree *tree, uint32_t begin,
                           uint32_t end, const bool *clean, const struct orientation_lasting *lasting,
                           uint8_t *orientations);

    /* Writes how far records begin to end - 1, multiples of 8, are from their reference at positions x, in a frame with
     * this origin; returns the square of the greatest distance. */
    double (*skin_move)(struct bvh_skin *s, uint32_t begin, uint32_t end, const double *x,
                        const double origin[3]);

    /* Do the signs of leaves begin to end - 1 last throughout an interval, after skin_move to its end? */
    bool (*skin_signs)(const struct bvh_skin *s, uint32_t begin, uint32_t end, const double *x0,
                       const double *x1);

    /* Writes the squared distances of a point, which is framed with its rounding as a box, from the boxes of eight children,
     * whose bounds these are; also of lanes that are not used. They are off by less than 2^-20 of themselves. */
    void (*near_children)(const float *bounds, const struct framed_query *q, float *out);

    /* Which of a leaf's eight triangles may be as near to such a point at the start as the root of squared? */
    uint32_t (*near_triangles)(const struct bvh *hierarchy, const struct bvh_tree *tree,
                               const struct bvh_leaf *leaf, const struct framed_query *q, double squared);

    /* Visits block pairs of the lane's stack, at most visits_max, until it is empty or there is no room for
     * what another visit may add. */
    void (*search)(const struct traversal *t, struct traversal_lane *lane, size_t visits_max);
} bvh_kernels;

DECLARE_KERNELS(bvh_kernels);

static inline const bvh_kernels *bvh_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, bvh_kernels);
}
