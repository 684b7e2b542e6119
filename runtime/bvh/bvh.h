/* Trees over the triangles: one per tree of the mesh, each in a frame that moves with its tree.
 *
 * Eight triangles are a leaf, eight leaves a block, eight blocks a block of the next level; all trees have
 * the same height, above which blocks of trees join them into one. Bounds are floats in the tree's own frame,
 * scaled by a power of two that is common to all; docs/theory/trees.md derives how far they are rounded. */
#pragma once

#include "runtime/bvh/bvh_kernels.h"
#include "src/core/kdop.h"
#include "src/mesh/mesh.h"

/* 8^10 leaves hold more triangles than there may be, and 8^11 more trees. */
enum { TREE_LEVEL_MAX = 10, BVH_LEVEL_MAX = TREE_LEVEL_MAX + 11 };

/* Corners are records; empty lanes, at the end of a tree's last leaf, repeat the first triangle's. */
typedef struct bvh_leaf {
    uint32_t corners[3][LANES];
    uint32_t triangles[LANES]; /* UINT32_MAX: empty */
} bvh_leaf;

/* Sets of lanes: of a leaf's triangles, or of a block's children, that hold triangles at all, triangles that
 * are all PLUS, all MINUS; newly_kept: that (may) have lost their flag since the pass before. */
typedef struct lane_flags {
    uint8_t used, plus, minus, newly_kept;
} lane_flags;

/* Children of block i are first_children[i] and those after it, of the level below; on level 0 leaves, on the
 * BVH's tree level trees. */
typedef struct bvh_level {
    uint32_t block_count;
    uint32_t *first_children;
    float *bounds; /* per block and axis 8 lows and 8 highs; no less than none for empty lanes */
    lane_flags *flags;
    uint64_t
        *self_pairs; /* byte i of a block: its children that are to be compared with child i; NULL: all */
    uint8_t
        *obstacle_lanes; /* per block: its children that hold obstacles only, which are not compared with each
                       * other; NULL: none, as below the tree level */
} bvh_level;

/* A region, or a component. Its frame takes origin[0] from positions at the start and origin[1] at the end,
 * and multiplies by the BVH's scale. */
typedef struct bvh_tree {
    uint32_t region;
    bool skip_adjacent; /* pairs of its triangles that share a vertex are not looked for */
    uint32_t first_leaf, leaf_count, first_record, record_count;
    uint32_t first_blocks[TREE_LEVEL_MAX]; /* per level below the tree level */
    double origin[2][3];
    float reach;           /* no scaled coordinate of the interval at hand is larger */
    float slack[2];        /* bounds are rounded outward by so much along axes, and along diagonals */
    float detector[2][3];  /* its detector point in its frame */
    double weighted[2][3]; /* the mean of its records by their weights, at the start and at the end */
} bvh_tree;

/* Records begin to end - 1 of a tree: what one thread copies in at a time. */
typedef struct record_chunk {
    uint32_t tree, begin, end;
    copied copied;
} record_chunk;

typedef struct bvh {
    const cscd_mesh *mesh;
    const bvh_kernels *kernels;
    int axis_count; /* of the volumes of blocks' children: BOX_AXES or KDOP_AXES */
    uint32_t tree_count, leaf_count, record_count;
    bvh_tree *trees;
    bvh_leaf *leaves;
    lane_flags *leaf_flags; /* of triangles */
    lane_flags *flags_before;
    uint64_t *leaf_self_pairs;          /* as in a level, of triangles; NULL: all */
    uint32_t *block_trees, *leaf_trees; /* of the blocks of level 0, and of leaves */
    uint32_t *record_vertices;          /* the mesh's vertex of a record */
    float *record_weights;              /* in the detector point */
    record_chunk *chunks;
    uint32_t chunk_count;
    float (*records)[8]; /* x y z . at the start, x y z . at the end, scaled, in the tree's frame */
    bvh_level levels[BVH_LEVEL_MAX];
    int tree_level, level_count; /* on the tree level children are trees, and the last level has one block */
    double scale;
    uint32_t *slots; /* where a triangle is: 8 * leaf + lane */
} bvh;

/* Triangles in regions 0 to count - 1, none of them empty; weights of triangles in their region's detector
 * point, which add up to 1 per region. */
typedef struct bvh_regions {
    const uint32_t *of_triangle;
    const double *triangle_weights;
    uint32_t count;
} bvh_regions;

/* Orders triangles and shapes the trees by positions. *out is untouched
 * unless CSCD_OK. */
cscd_status bvh_build(const cscd_mesh *mesh, bvh_regions regions, const double *positions, int axis_count,
                      bvh *out);
void bvh_free(bvh *f);

/* Fills in the levels' obstacles children; a step of bvh_build. False: no memory. */
bool bvh_mark_obstacles(bvh *f);

static inline uint32_t bvh_triangle(const bvh *f, uint32_t slot) {
    return f->leaves[slot / LANES].triangles[slot % LANES];
}

/* Moves frames, records and bounds on to the interval from x0 to x1; the same array twice: to a moment. All
 * flags are cleared and no pair is hidden. distance: volumes are widened so that those of what comes within
 * it overlap. */
void bvh_refit(bvh *f, const double *x0, const double *x1, double distance);

/* No pair is hidden by `within`, where there is such a thing. */
void bvh_show_all(bvh *f);

/* Makes room for hidden pairs, of which there are none yet. False: no memory. */
bool bvh_allow_hiding(bvh *f);

static inline bool bvh_can_hide(const bvh *f) {
    return f->leaf_self_pairs != NULL;
}

/* Whose pairs of adjacent triangles are left out: per component; NULL: nobody's. */
void bvh_skip_adjacent(bvh *f, const bool *components);

/* Orientation of a triangle as seen from a detector point d during a whole interval. PLUS (MINUS) certifies that
 * (p0 - d) . n > 0 (< 0) at every moment, with n = (p1 - p0) x (p2 - p0); ZERO is everything else. */
enum { ORIENTATION_PLUS = 1, ORIENTATION_MINUS = 2, ORIENTATION_ZERO = 3 };

/* May two triangles of one region with these orientations, or any of two sets of triangles, be the first to touch? Not
 * if all are PLUS, and not if all are MINUS (docs/theory/culling.md). */
static inline bool orientations_may_touch(uint8_t a, uint8_t b) {
    return (a | b) == ORIENTATION_ZERO;
}

/* Which triangles are oriented, and from where. */
typedef struct orientation_query {
    const bool *culled;                  /* per component: only triangles of these are oriented */
    const bool *clean;                   /* per triangle: all others are ZERO; NULL: all are clean */
    const double (*detector_offsets)[3]; /* per region: from the weighted mean to the detector point */
    bool still;                          /* detector points stay where they are at the start */
} orientation_query;

/* Where the detector points are at both ends of the interval moved to last, per region, up to rounding. */
void bvh_detector_points(const bvh *f, const orientation_query *view, double (*points)[2][3]);

/* Detector points and flags of the interval moved to last; orientations: per triangle of the mesh, written
 * where they count. */
void bvh_orient(bvh *f, const orientation_query *view, uint8_t *orientations);

/* Flags of leaves and blocks anew, from orientations per triangle before and now: newly_kept is what has lost
 * its. */
void bvh_mark_newly_kept(bvh *f, const uint8_t *before, const uint8_t *now);

/* Fresh are these triangles, and there are no other flags. */
void bvh_mark_unproven(bvh *f, const bool *unproven);
