/* The files of the BVH share this: the kernels, the steps of building, volumes where boxes overlap too much, the skin. */
#pragma once

#include "runtime/bvh/bvh.h"

/* ---- records ----------------------------------------------------------------------------------------------- */

enum { BVH_CHUNK_RECORDS = 1024 };

/* The copied records: the largest magnitude of a coordinate, and the weighted sums of the coordinates at
 * the start and at the end. */
typedef struct copied {
    double reach, weighted[2][3];
} copied;

/* Records begin to end - 1 of a tree. One thread copies in one chunk at a time. */
typedef struct record_chunk {
    uint32_t tree, begin, end;
    copied copied;
} record_chunk;

/* ---- the kernels ------------------------------------------------------------------------------------------- */

/* A box in the frame of a tree, rounded outward. */
typedef struct framed_query {
    float low[3], high[3];
} framed_query;

/* Sums of extents along the axes, over all leaves and over all triangles. */
typedef struct extents {
    double leaves, triangles;
} extents;

typedef struct bvh_kernels {
    /* Fills records begin to end - 1, multiples of 8, of a tree. */
    void (*copy_in)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                    const double *x0, const double *x1, copied *out);

    /* Computes the bounds of the children of blocks begin to end - 1 of any level but the tree level. */
    void (*refit)(const bvh *hierarchy, int level, uint32_t begin, uint32_t end);

    /* Sums the extents of all leaves, and those of all triangles, at the start. */
    extents (*extents_at_start)(const bvh *hierarchy);

    /* Writes the flags of leaves begin to end - 1 of a tree, and the orientations of their triangles. clean has an
     * element per triangle of the mesh, and triangles that are not clean become ZERO; NULL: all are clean. */
    void (*orient)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                   const bool *clean, uint8_t *orientations);

    /* The same for orientations that last: see orientation_query. */
    void (*orient_lasting)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                           const bool *clean, const orientation_lasting *lasting, uint8_t *orientations);

    /* Writes how far records begin to end - 1, multiples of 8, are from their reference at positions x, in a frame with
     * this origin; returns the square of the greatest distance. */
    double (*skin_move)(bvh_skin *s, uint32_t begin, uint32_t end, const double *x, const double origin[3]);

    /* Tells whether the signs of leaves begin to end - 1 last throughout an interval, after skin_move to its end. */
    bool (*skin_signs)(const bvh_skin *s, uint32_t begin, uint32_t end, const double *x0, const double *x1);

    /* Writes the squared distances of a point, which is framed with its rounding as a box, from the boxes of eight children,
     * whose bounds these are; also of lanes that are not used. They are off by less than 2^-20 of themselves. */
    void (*near_children)(const float *bounds, const framed_query *q, float *out);

    /* Returns which of a leaf's eight triangles may be as near to such a point at the start as the root of squared. */
    uint32_t (*near_triangles)(const bvh *hierarchy, const bvh_tree *tree, const bvh_leaf *leaf,
                               const framed_query *q, double squared);

    /* Visits block pairs of the worker's stack, at most visits_max, until it is empty or there is no room for
     * what another visit may add. */
    void (*search)(const traversal *t, traversal_worker *worker, size_t visits_max);
} bvh_kernels;

DECLARE_KERNELS(bvh_kernels);

static inline const bvh_kernels *bvh_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, bvh_kernels);
}

/* ---- building ---------------------------------------------------------------------------------------------- */

/* A triangle of a region, or a region. */
typedef struct placed_item {
    float centre[3];
    uint32_t name;
} placed_item;

/* Runs of items: run r is items[offsets[r] .. offsets[r + 1]). */
typedef struct item_runs {
    placed_item *items;
    const uint32_t *offsets;
    uint32_t count;
} item_runs;

/* Splits each run at the middle of its longest extent, then each side, down to LANES items; items of one coordinate, and those
 * that end up together, keep their order. All threads share the work, and the result is the same for any number of them.
 * False: no memory, or the call is cancelled, and the items of a run are in any order. */
bool bvh_order_runs(cscd_context *context, item_runs runs);

/* Names the objects of trees and fills in obstacle_lanes, as a step of bvh_build. False: no memory. */
bool bvh_mark_objects(bvh *hierarchy);

/* Frees obstacle_lanes and child_sets, as a step of bvh_free. */
void bvh_free_objects(bvh *hierarchy);

/* Frees collapsed_lanes, as a step of bvh_free. */
void bvh_free_collapsed(bvh *hierarchy);

/* ---- second volumes ---------------------------------------------------------------------------------------- */

/* The volumes of all triangles at a hub overlap there. They are told apart by the directions in which they lie as seen from
 * the hub or, where they share two hubs like the pages of a book, as seen from the edge between these. */
enum { NO_HUB = UINT32_MAX };

/* The places of the triangles below a child, as seen from a vertex that all of them share. */
typedef struct hub_volume {
    uint32_t hub;   /* the vertex; NO_HUB: they share none, or nothing is known of their directions */
    uint32_t other; /* NO_HUB, or another one, of a greater number */

    /* A box around all unit vectors towards them during the interval. With two hubs: around their unit normals, where the
     * vectors from hub to other and from hub to the third corner are a right-handed pair. */
    double low[3], high[3];

    float reach; /* the sides opposite the hub come no nearer to it; not scaled, as what follows */

    /* The hub, and the sides opposite it: at both ends of the interval, the least and the greatest coordinates. */
    double boxes[2][2][2][3];
} hub_volume;

/* Tells whether features of the triangles of a are farther than the distance from those of b throughout the interval,
 * except for features with a common vertex. */
bool hub_volumes_apart(const hub_volume *a, const hub_volume *b, double distance);

/* The boxes of slivers that lie side by side along a diagonal all overlap. They are told apart by the hulls of two boxes,
 * one around their near ends and one around their far ends; in doubles, because large triangles may lie on each other more
 * closely than floats tell. */

/* The places of the triangles below a child: each corner is in one of the two boxes. Not scaled. */
typedef struct sliver_volume {
    /* Near or far, at both ends of the interval: the least and the greatest coordinates. */
    double boxes[2][2][2][3];

    int axis; /* far ends are the greater ones along this axis; -1: nothing is known */
} sliver_volume;

/* Tells whether triangles of a are farther than the distance from those of b throughout the interval. */
bool sliver_volumes_apart(const sliver_volume *a, const sliver_volume *b, double distance);

/* Makes room for them, as a step of bvh_build: hub volumes where the mesh has a hub, sliver volumes where half of the triangles
 * are slivers or large at these positions. False: no memory. */
bool bvh_allocate_second_volumes(bvh *hierarchy, const double *positions);

/* Frees them, as a step of bvh_free. */
void bvh_free_second_volumes(bvh *hierarchy);

/* Finds them for the interval from x0 to x1, as a step of bvh_refit. */
void bvh_refit_second_volumes(bvh *hierarchy, const double *x0, const double *x1);

/* ---- the skin ---------------------------------------------------------------------------------------------- */

/* Records of one tree that one thread looks at at a time, and what it finds. */
typedef struct skin_chunk {
    uint32_t tree, begin, end;
    double farthest; /* squared */
} skin_chunk;

typedef struct skin_tree {
    uint32_t region, first_record, record_count;
    double origin[3];  /* of its frame at the reference, and */
    double ends[2][3]; /* at both ends of the interval looked at */
    double reach;
    float detector[3]; /* in the frame, where it stays */
} skin_tree;

typedef struct skin_leaf {
    uint32_t corners[3 * LANES]; /* records */
    uint32_t tree;
    uint8_t plus, minus; /* as in lane_flags */
} skin_leaf;

enum { SKIN_LEAVES = 256 };
