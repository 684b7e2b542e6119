/* Bounding volume hierarchy over the triangles: one tree per region, each in a frame that moves with it.
 *
 * Eight triangles are a leaf, eight leaves a block, eight blocks a block of the next level. All trees have the same
 * height; above it, blocks of trees join them into one:
 *
 *     level_count - 1    one block             children: blocks
 *     ...
 *     tree_level         blocks of trees       children: trees, that is, their blocks on the level below
 *     tree_level - 1     one block per tree    children: blocks
 *     ...
 *     0                                        children: leaves
 *
 * Bounds are floats in the frame of their tree, scaled by a power of two that all trees have in common, and on the tree
 * level and above in the frame of the first tree. docs/theory/trees.md derives how far they are rounded outward. */
#pragma once

#include "runtime/bvh/bvh_kernels.h"
#include "runtime/bvh/object_set.h"
#include "src/core/kdop.h"
#include "src/mesh/mesh.h"

/* 8^10 leaves hold more triangles than a mesh may have, and 8^11 is more than the number of trees. */
enum { TREE_LEVEL_MAX = 10, BVH_LEVEL_MAX = TREE_LEVEL_MAX + 11 };

/* Triangles fill a prefix of the lanes. Corners are records; the empty lanes of a tree's last leaf repeat those of its
 * first triangle. */
typedef struct bvh_leaf {
    uint32_t corners[3][LANES];
    uint32_t triangles[LANES]; /* UINT32_MAX: empty */
} bvh_leaf;

/* Sets of lanes: of the triangles of a leaf, or of the children of a block. */
typedef struct lane_flags {
    uint8_t used;        /* lanes that hold triangles; a prefix of all lanes */
    uint8_t plus, minus; /* lanes whose triangles are all PLUS, or all MINUS */
    uint8_t
        newly_kept; /* lanes with unproven triangles or some that have lost their orientation since the last pass */
} lane_flags;

/* Child i of a block is first_children + i on the level below: a leaf on level 0, a tree on the tree level. */
typedef struct bvh_level {
    uint32_t block_count;
    uint32_t *first_children;
    float *bounds; /* per block and axis 8 lows and 8 highs; in empty lanes the low is above the high */
    lane_flags *flags;

    /* Byte i of a block: the children that child i is compared with, itself included. NULL: with all of them. */
    uint64_t *self_pairs;

    /* The children of each block that hold obstacles only, which are not compared with each other; NULL: none do. */
    uint8_t *obstacle_lanes;

    /* With rules for objects: per block the objects that each of its eight children holds. Pairs of children that can
     * hold none that are looked at are not compared; obstacle_lanes is not read then. NULL: there are no rules. */
    object_set *child_sets;

    /* Per child of a block, how its triangles lie around a vertex of very many triangles; NULL: there is no such vertex. */
    struct hub_volume *child_hubs;

    /* Per child of a block, how its slivers lie; NULL: the mesh does not consist of slivers or large triangles. */
    struct sliver_volume *child_slivers;

    /* The children of each block without any active triangle, which are not compared with each other; NULL: all
     * triangles are active. */
    uint8_t *inactive_lanes;

    /* From the tree level on: the children of each block that hold nothing but collapsed components, as
     * bvh_mark_collapsed was told last. NULL: it was never called. */
    uint8_t *collapsed_lanes;
} bvh_level;

/* The tree of one region. Its frame subtracts origin[0] from positions at the start, origin[1] from those at the end,
 * and multiplies by the BVH's scale. */
typedef struct bvh_tree {
    uint32_t region;
    uint32_t object;    /* OBJECT_SEVERAL: only where a baseline has joined components */
    uint32_t missing;   /* so many triangles are still to be put into it; 0: it is whole */
    bool skip_adjacent; /* the traversal leaves out pairs of its triangles that share a vertex */
    uint32_t first_leaf, leaf_count, first_record, record_count;
    uint32_t first_blocks[TREE_LEVEL_MAX]; /* per level below the tree level */
    double origin[2][3];
    float reach;           /* no scaled coordinate in the interval has a larger magnitude */
    float slack[2];        /* how far bounds are rounded outward: along axes, and along diagonals */
    float detector[2][3];  /* its detector point in its frame */
    double weighted[2][3]; /* the mean of its records by their weights, at the start and at the end */
} bvh_tree;

enum { BVH_CHUNK_RECORDS = 1024 };

/* Records begin to end - 1 of a tree. One thread copies in one chunk at a time. */
typedef struct record_chunk {
    uint32_t tree, begin, end;
    copied copied;
} record_chunk;

typedef struct bvh {
    const cscd_mesh *mesh;
    const bvh_kernels *kernels;
    int axis_count; /* of the volumes of blocks' children: BOX_AXES or KDOP_AXES */
    uint32_t tree_count, leaf_count, record_count, record_capacity;
    uint32_t missing_begin, missing_end; /* the triangles of missing trees are some of these */
    bvh_tree *trees;
    bvh_leaf *leaves;
    lane_flags *leaf_flags;             /* of triangles */
    lane_flags *flags_before;           /* the leaf_flags before the last bvh_mark_newly_kept */
    uint64_t *leaf_self_pairs;          /* like self_pairs of a level, but of triangles; NULL: all */
    uint8_t *leaf_inactive;             /* like inactive_lanes of a level, but of triangles */
    uint32_t *block_trees, *leaf_trees; /* the tree of each block of level 0, and of each leaf */
    uint32_t *record_vertices;          /* the mesh's vertex of a record */
    float *record_weights;              /* per record, its weight in the detector point */
    record_chunk *chunks;               /* in the order of the trees */
    uint32_t chunk_count;
    float (*records)[8]; /* x y z . at the start, x y z . at the end, scaled, in the tree's frame */
    bvh_level levels[BVH_LEVEL_MAX];
    int tree_level, level_count;
    double scale;
    bool still;             /* the last refit was to a moment: both ends of everything are the same */
    bool keeps_hub_pairs;   /* the traversal leaves out no pair because of a vertex of very many triangles */
    double hub_distance;    /* for which child_hubs and child_slivers tell triangles apart */
    bool trees_mix_objects; /* some tree holds several objects */
    uint32_t *slots;        /* per triangle, where it is: 8 * leaf + lane */
} bvh;

/* Triangles in regions 0 to count - 1, none of them empty, and none in two components unless joined on purpose by a
 * baseline; the weights of a region's triangles in its detector point add up to 1. */
typedef struct bvh_regions {
    const uint32_t *of_triangle;
    const double *triangle_weights;
    uint32_t count;
} bvh_regions;

/* Orders the triangles and shapes the trees by positions; bounds and records are undefined before the first
 * bvh_refit. *out is untouched unless CSCD_OK; CANCELLED: the call that builds them is. */
cscd_status bvh_build(const cscd_mesh *mesh, bvh_regions regions, const double *positions, int axis_count,
                      bvh *out);
void bvh_free(bvh *hierarchy);

/* Builds what bvh_move_over (bvh_move.h) has left out, as a step of its own; positions shape the trees that are missing.
 * sets, active: as for bvh_set_objects and bvh_set_active. On failure everything that was there stays, so that it can be
 * called again. */
cscd_status bvh_finish(bvh *hierarchy, bvh_regions regions, const object_set *sets, const bool *active,
                       const double *positions);

/* How many triangles are in missing trees. */
uint32_t bvh_count_missing(const bvh *hierarchy);

/* Adds all blocks above the leaves, as a step of bvh_build; counts: scratch, one number per tree. False: no memory. */
bool bvh_build_levels(bvh *hierarchy, uint32_t *counts);

/* Frees them, as a step of bvh_free. */
void bvh_free_levels(bvh *hierarchy);

/* Names the objects of trees and fills in obstacle_lanes, as a step of bvh_build. False: no memory. */
bool bvh_mark_objects(bvh *hierarchy);

/* Frees obstacle_lanes and child_sets, as a step of bvh_free. */
void bvh_free_objects(bvh *hierarchy);

/* Fills in child_sets; sets: one for each object, NULL: there are no rules. False: no memory, and nothing has changed. */
bool bvh_set_objects(bvh *hierarchy, const object_set *sets);

/* Makes the traversal leave out pairs of inactive triangles. active: per triangle, NULL: all are. False: no memory, and
 * nothing has changed; that is only where all were active. */
bool bvh_set_active(bvh *hierarchy, const bool *active);

/* Returns the first disagreement with what bvh_set_active would do as a sentence, or NULL. */
const char *bvh_check_active(const bvh *hierarchy, const bool *active);

/* Notes which trees and blocks hold nothing but triangles of these components, for traversals that skip such pairs.
 * collapsed: per component. False: no memory. */
bool bvh_mark_collapsed(bvh *hierarchy, const bool *collapsed);

/* Frees collapsed_lanes, as a step of bvh_free. */
void bvh_free_collapsed(bvh *hierarchy);

static inline uint32_t bvh_triangle(const bvh *hierarchy, uint32_t slot) {
    return hierarchy->leaves[slot / LANES].triangles[slot % LANES];
}

/* How far volumes are widened: so far that those of two triangles overlap when the triangles come within the distance
 * of each other or, if this is more, within the mean of their objects' distances. */
typedef struct volume_growth {
    double distance;
    const double *of_objects; /* NULL: the distance is that of all */
    double beyond;            /* is added to all these distances */
} volume_growth;

static inline volume_growth uniform_growth(double distance) {
    return (volume_growth){.distance = distance};
}

/* Moves frames, records and bounds to the interval from x0 to x1, or to a moment if both are the same array. Clears
 * all flags and shows all hidden pairs. Widens the volumes. */
void bvh_refit(bvh *hierarchy, const double *x0, const double *x1, volume_growth growth);

/* Returns the first fault of the structure as a sentence, or NULL. After a build it checks that lanes fill prefixes,
 * that the blocks of one tree and level lie together, and that slots and leaves are inverse. After a refit it also
 * checks that bounds hold the bounds below them. Takes linear time; asserts call it in debug and sanitizer builds. */
const char *bvh_validate(const bvh *hierarchy, bool refitted);

/* Shows all pairs that are hidden, where there is room for hidden pairs. */
void bvh_show_all(bvh *hierarchy);

/* Makes room for hidden pairs. None is hidden yet. False: no memory. */
bool bvh_allow_hiding(bvh *hierarchy);

static inline bool bvh_can_hide(const bvh *hierarchy) {
    return hierarchy->leaf_self_pairs != NULL;
}

/* Makes the traversal leave out pairs of adjacent triangles in the given components; NULL: in none. */
void bvh_skip_adjacent(bvh *hierarchy, const bool *components);

/* The same in all components, but pairs whose common vertices are all shared by very many triangles are kept: their number
 * grows with its square, and the traversal can tell most of them apart. */
void bvh_skip_all_adjacent(bvh *hierarchy);

/* Orientation of a triangle as seen from a detector point d during a whole interval. PLUS (MINUS) certifies that
 * (p0 - d) . n > 0 (< 0) at every moment, with n = (p1 - p0) x (p2 - p0); ZERO is everything else. */
enum { ORIENTATION_PLUS = 1, ORIENTATION_MINUS = 2, ORIENTATION_ZERO = 3 };

/* Can two triangles of one region with these orientations, or any two from two sets of triangles, be the first to
 * touch? They cannot if all are PLUS, nor if all are MINUS (docs/theory/culling.md). */
static inline bool orientations_may_touch(uint8_t a, uint8_t b) {
    return (a | b) == ORIENTATION_ZERO;
}

/* How much orientations have to endure (runtime/bvh/bvh_skin.h): by how much vertices may be off, and the least by which two
 * corners of a triangle may differ in this. Scaled. */
typedef struct orientation_lasting {
    float distance, stretch;
    float *of_leaves; /* written: by how much they may differ in each leaf; infinity where all are ZERO */
} orientation_lasting;

/* Says which triangles are oriented, and from which points. */
typedef struct orientation_query {
    const bool *culled;                  /* per component: only triangles of these are oriented */
    const bool *clean;                   /* per triangle: all others are ZERO; NULL: all are clean */
    const double (*detector_offsets)[3]; /* per region: from the weighted mean to the detector point */

    /* After a refit to a moment: orientations last while vertices and detector points stay near their places in the frames
     * of their trees, the latter exactly there. NULL: they are those of the interval. */
    const orientation_lasting *lasting;
} orientation_query;

/* Writes where the detector point of each region is at both ends of the last interval, up to rounding. */
void bvh_detector_points(const bvh *hierarchy, const orientation_query *view, double (*points)[2][3]);

/* Sets the detector points and the flags of the last interval. Writes the orientations of the triangles that are
 * oriented, per triangle of the mesh. */
void bvh_orient(bvh *hierarchy, const orientation_query *view, uint8_t *orientations);

/* Sets the flags of leaves and blocks from the orientations of the triangles before and now. A triangle is newly
 * kept if it had an orientation and has none now. */
void bvh_mark_newly_kept(bvh *hierarchy, const uint8_t *before, const uint8_t *now);

/* Marks these triangles as newly kept, and clears all other flags. */
void bvh_mark_unproven(bvh *hierarchy, const bool *unproven);
