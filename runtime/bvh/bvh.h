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
 * level and above in the frame of the first tree. bvh_refit.c derives how far they are rounded outward. */
#pragma once

#include "src/core/context.h"
#include "src/core/kernels.h"
#include "src/core/vec3.h"
#include "src/mesh/mesh.h"

#include <stdatomic.h>

struct bvh_kernels;
struct cscd_mesh_change;

/* ---- sets of objects --------------------------------------------------------------------------------------- */

/* In place of the object of a tree, before bvh_build or bvh_finish has found it. */
#define OBJECT_UNKNOWN UINT32_MAX

/* The library's own categories. An obstacle is compared with free objects only, unless it and another obstacle ask for
 * each other. */
enum { OBJECT_FREE = 1, OBJECT_OBSTACLE = 2, OBJECT_ASKING_OBSTACLE = 4 };

/* A set of one object or more. What the set says holds for some of its objects. */
typedef struct object_set {
    /* The caller's: two objects are compared if the category of each is in the mask of the other. */
    uint64_t categories, masks;

    /* The library's, in the same way. The relation is symmetric. */
    uint8_t kinds, kinds_sought;

    bool self;            /* an object is compared with itself */
    uint32_t first, last; /* the least and the greatest object */
} object_set;

/* Tells whether two sets of one object say the same of their objects. */
static inline bool object_sets_are_alike(const object_set *a, const object_set *b) {
    return a->categories == b->categories && a->masks == b->masks && a->kinds == b->kinds &&
           a->kinds_sought == b->kinds_sought && a->self == b->self;
}

static inline object_set object_sets_join(const object_set *a, const object_set *b) {
    return (object_set){.categories = a->categories | b->categories,
                        .masks = a->masks | b->masks,
                        .kinds = a->kinds | b->kinds,
                        .kinds_sought = a->kinds_sought | b->kinds_sought,
                        .self = a->self || b->self,
                        .first = a->first < b->first ? a->first : b->first,
                        .last = a->last > b->last ? a->last : b->last};
}

/* Tells whether an object of a is compared with one of b. Exact for sets of one object each; for larger sets it may be
 * true although there is no such pair. */
static inline bool object_sets_may_meet(const object_set *a, const object_set *b) {
    if (a->first <= b->last && b->first <= a->last) {
        if (a->self && b->self) return true;
        if (a->first == b->last && a->last == b->first) return false; /* one object and itself */
    }
    return (a->categories & b->masks) != 0 && (b->categories & a->masks) != 0 &&
           (a->kinds & b->kinds_sought) != 0;
}

/* ---- trees ------------------------------------------------------------------------------------------------- */

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

    /* Lanes with unproven triangles, or with triangles that have lost their orientation since the last pass. */
    uint8_t newly_kept;
} lane_flags;

/* Child i of a block is first_children + i on the level below: a leaf on level 0, a tree on the tree level. */
typedef struct bvh_level {
    uint32_t block_count;
    uint32_t *first_children;
    float *bounds; /* per block and axis 8 lows and 8 highs; in empty lanes the low is above the high */
    lane_flags *flags;

    /* Byte i of a block: the children that child i is compared with, itself included. NULL: with all of them. */
    uint64_t *self_pairs;

    /* Per block, the children that hold nothing but obstacles, which are not compared with each other; NULL: none. */
    uint8_t *obstacle_lanes;

    /* With rules for objects: the objects that each of a block's eight children holds. Two children are compared only if
     * some of their objects are; obstacle_lanes is not read then. NULL: there are no rules. */
    object_set *child_sets;

    /* The places of the triangles of each child of a block around a hub; NULL: the mesh has no hub. */
    struct hub_volume *child_hubs;

    /* The places of the slivers of each child of a block; NULL: the mesh is not made of slivers or large triangles. */
    struct sliver_volume *child_slivers;

    /* Per block, the children without an active triangle, which are not compared with each other; NULL: all triangles
     * are active. */
    uint8_t *inactive_lanes;

    /* From the tree level on: per block, the children that hold nothing but collapsed components, by the last
     * bvh_mark_collapsed. NULL: it was never called. */
    uint8_t *collapsed_lanes;
} bvh_level;

/* The tree of one region. Its frame subtracts origin[0] from positions at the start, origin[1] from those at the end,
 * and multiplies by the BVH's scale. */
typedef struct bvh_tree {
    uint32_t region;
    uint32_t object;    /* the one that its component lies in */
    uint32_t missing;   /* the number of triangles that are still to be put into it; 0: it is complete */
    bool skip_adjacent; /* the traversal leaves out pairs of its triangles that share a vertex */
    uint32_t first_leaf, leaf_count, first_record, record_count;
    uint32_t first_blocks[TREE_LEVEL_MAX]; /* per level below the tree level */
    double origin[2][3];
    float reach;           /* no scaled coordinate in the interval has a larger magnitude */
    float slack[2];        /* how far bounds are rounded outward: along axes, and along diagonals */
    float detector[2][3];  /* its detector point in its frame */
    double weighted[2][3]; /* the mean of its records by their weights, at the start and at the end */
} bvh_tree;

typedef struct bvh {
    const cscd_mesh *mesh;
    const struct bvh_kernels *kernels;
    int axis_count; /* of the volumes of blocks' children: BOX_AXES or KDOP_AXES */
    uint32_t tree_count, leaf_count, record_count, record_capacity;
    uint32_t missing_begin, missing_end; /* the triangles of missing trees are some of these */
    bvh_tree *trees;
    bvh_leaf *leaves;
    lane_flags *leaf_flags;    /* of triangles */
    lane_flags *flags_before;  /* the leaf_flags before the last bvh_mark_newly_kept */
    uint64_t *leaf_self_pairs; /* like self_pairs of a level, but of triangles; NULL: all */
    uint8_t *leaf_inactive;    /* like inactive_lanes of a level, but of triangles */
    bool has_inactive;         /* the marks of inactive triangles count; their memory may outlive them */
    uint32_t *block_trees, *leaf_trees; /* the tree of each block of level 0, and of each leaf */
    uint32_t *record_vertices;          /* the mesh's vertex of a record */
    float *record_weights;              /* per record, its weight in the detector point */
    struct record_chunk *chunks;        /* in the order of the trees */
    uint32_t chunk_count;
    float (*records)[8]; /* x y z . at the start, x y z . at the end, scaled, in the tree's frame */
    bvh_level levels[BVH_LEVEL_MAX];
    int tree_level, level_count;
    double scale;
    bool still;           /* the last refit was to a moment: both ends of everything are the same */
    bool keeps_hub_pairs; /* adjacent triangles are left out only if they share another vertex than a hub */
    double hub_distance;  /* for which child_hubs and child_slivers tell triangles apart */
    uint32_t *slots;      /* per triangle, where it is: 8 * leaf + lane */
} bvh;

static inline uint32_t bvh_tree_component(const bvh *hierarchy, const bvh_tree *tree) {
    return hierarchy->mesh->triangle_components[hierarchy->leaves[tree->first_leaf].triangles[0]];
}

static inline uint32_t bvh_triangle(const bvh *hierarchy, uint32_t slot) {
    return hierarchy->leaves[slot / LANES].triangles[slot % LANES];
}

/* Triangles in regions 0 to count - 1, none of which is empty or spans two components; the weights of a region's triangles
 * in its detector point add up to 1. */
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

/* ---- what traversals leave out ----------------------------------------------------------------------------- */

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

/* ---- an interval ------------------------------------------------------------------------------------------- */

/* By how much volumes are widened, so that those of two triangles overlap when the triangles come within the distance
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

/* The same in all components, except that pairs which share nothing but hubs are kept: a hub of n triangles has n^2 / 2
 * pairs, most of which the traversal tells apart. */
void bvh_skip_all_adjacent(bvh *hierarchy);

/* ---- orientations ------------------------------------------------------------------------------------------ */

/* Orientation of a triangle as seen from a detector point d during a whole interval. PLUS (MINUS) certifies that
 * (p0 - d) . n > 0 (< 0) at every moment, with n = (p1 - p0) x (p2 - p0); ZERO is everything else. */
enum { ORIENTATION_PLUS = 1, ORIENTATION_MINUS = 2, ORIENTATION_ZERO = 3 };

/* Tells whether two triangles of one region with these orientations, or any two from two sets of triangles, can be the
 * first to touch. They cannot if all are PLUS, nor if all are MINUS (docs/theory/culling.md). */
static inline bool orientations_may_touch(uint8_t a, uint8_t b) {
    return (a | b) == ORIENTATION_ZERO;
}

/* The motion that orientations have to outlast: how far vertices may be from their places, and the least by which two
 * corners of a triangle may differ in this. Scaled. */
typedef struct orientation_lasting {
    float distance, stretch;
    float *of_leaves; /* output: by how much they may differ in each leaf; infinity where all are ZERO */
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

/* ---- trees that follow a motion ---------------------------------------------------------------------------- */

/* The extent of leaves as a multiple of that of their triangles, and the extent of blocks of trees as a multiple of
 * that of their trees. */
typedef struct bvh_spread {
    double leaves, trees;
} bvh_spread;

/* The input that trees are built from, and how loose they have become since. */
typedef struct bvh_rebuild {
    const cscd_mesh *mesh;
    bvh_regions regions;
    int axis_count;
    const object_set *objects; /* the rules for objects, one for each; NULL: there are none */
    const bool *active;        /* per triangle; NULL: all are */

    /* Trees that have moved over from another mesh, and are finished when trees are needed; mesh NULL: none. */
    bvh kept;

    bvh_spread spread_when_built;
    uint32_t intervals_unmeasured; /* intervals since the spread was last measured */
    uint32_t useless_rebuilds;     /* in a row, at most 4: each doubles the time to the next measurement */
    bool rebuilt;                  /* by the last call of bvh_rebuild_move */
} bvh_rebuild;

/* Refits the trees to the interval from x0 to x1, with volumes widened by growth. Before that it builds them from x0 if
 * there are none, or those that are missing from `kept`.
 *
 * A refit keeps together what was near when the trees were built. So the spread is measured every 16th interval; where
 * it has grown by a quarter, the trees are rebuilt from x0. After a rebuild that was of no use the next measurement
 * waits twice as long. Spreads are compared with volumes that are widened by step_growth, whatever the growth.
 * All this depends on positions alone. Without memory for new trees the old ones stay. A mesh without triangles has
 * no trees. */
cscd_status bvh_rebuild_move(bvh_rebuild *r, bvh *hierarchy, const double *x0, const double *x1,
                             volume_growth growth, volume_growth step_growth);

/* Refits the trees to a moment, and builds them first if there are none. It measures nothing, because only intervals
 * count. */
cscd_status bvh_rebuild_move_to(bvh_rebuild *r, bvh *hierarchy, const double *positions, volume_growth growth,
                                volume_growth step_growth);

/* ---- trees that move over to another mesh, and copies ------------------------------------------------------ */

/* A region that has no tree yet, which is a component of its own. */
typedef struct fresh_region {
    uint32_t region, triangle_count, vertex_count;
    uint32_t after; /* its tree comes after that of this old region; UINT32_MAX: at the end */
} fresh_region;

/* The new numbers of the trees that are kept, and the regions that have no tree yet. */
typedef struct bvh_move {
    const cscd_mesh *mesh; /* the new one */
    const struct cscd_mesh_change *change;
    const uint32_t *regions; /* per old one the new one; UINT32_MAX: its tree is not kept */
    uint32_t old_region_count, region_count;
    const fresh_region *fresh; /* all regions that no old one becomes */
    uint32_t fresh_count;
} bvh_move;

/* Copies the trees that are kept, and makes room for the others, which are missing: only bvh_finish, bvh_move_over and
 * bvh_free may be called then. There are no records, unless bvh_take_records gives them. Trees of the hierarchy
 * may be missing, too. On failure *out is untouched. */
cscd_status bvh_move_over(const bvh *hierarchy, const bvh_move *move, bvh *out);

/* Takes the memory for records from trees that are about to be freed, if it is enough. */
void bvh_take_records(bvh *hierarchy, bvh *from);

/* Copies everything; mesh: the same one in the context of the copy. On failure *out is untouched. */
cscd_status bvh_copy(const bvh *hierarchy, const cscd_mesh *mesh, bvh *out);

/* Builds the trees that bvh_move_over has left out, shaped by positions. sets, active: as for bvh_set_objects and
 * bvh_set_active. On failure everything that was there stays, so that it can be called again. */
cscd_status bvh_finish(bvh *hierarchy, bvh_regions regions, const object_set *sets, const bool *active,
                       const double *positions);

/* Counts the triangles of missing trees. */
uint32_t bvh_count_missing(const bvh *hierarchy);

/* ---- triangles near a point or a box ----------------------------------------------------------------------- */

/* Queries are for the moment of the last bvh_refit. A high of infinity is allowed. */
typedef struct query_box {
    double low[3], high[3];
} query_box;

/* Calls visit for each triangle whose bounding volume overlaps the box, and perhaps for some more. closed_only:
 * those of components that are no closed manifolds may be left out. */
void bvh_visit_box(const bvh *hierarchy, const query_box *box, bool closed_only,
                   void (*visit)(void *data, uint32_t triangle), void *data);

/* Asks for the triangles of an object, in components with this number. */
typedef struct near_quest {
    uint32_t object, number;
    const uint32_t *numbers; /* per component; NULL: all components */
} near_quest;

/* Calls visit for each triangle that was asked for, and perhaps for some others, whose bounding volume may be as near to
 * the point as the root of *squared, nearer blocks first; visit may lower *squared, which is a squared distance times
 * the square of the trees' scale, so that it neither overflows nor vanishes. INFINITY: any distance. */
void bvh_visit_near(const bvh *hierarchy, const near_quest *quest, const double point[3], double *squared,
                    void (*visit)(void *data, uint32_t triangle), void *data);

/* ---- self-traversal ---------------------------------------------------------------------------------------- */

/* A potentially colliding pair of different triangles, given by their slots. */
typedef struct triangle_pair {
    uint32_t a, b;
} triangle_pair;

/* Two blocks of one level whose children are still to be compared, or one block and itself. Below the tree level,
 * tree_a and tree_b are the trees that the blocks belong to. */
typedef struct block_pair {
    uint32_t a, b, tree_a, tree_b;
    int32_t level;
} block_pair;

/* Selects the pairs that a pass looks for, among the triangle pairs whose volumes overlap. */
typedef enum traversal_pass {
    TRAVERSAL_KEPT,       /* all that the flags keep, without hidden pairs and pairs of inactive triangles */
    TRAVERSAL_NEWLY_KEPT, /* those of them that the flags did not keep before */
    TRAVERSAL_UNPROVEN    /* pairs of two unproven triangles, active or not */
} traversal_pass;

/* Whether a pass finds pairs of trees that hold nothing but collapsed components. */
typedef enum collapsed_trees {
    COLLAPSED_FOUND,      /* it finds all */
    COLLAPSED_PAIRS_LEFT, /* it leaves out pairs of two such trees, and of one with itself */
    COLLAPSED_LEFT        /* it leaves out all pairs of such a tree */
} collapsed_trees;

/* Keeps the volumes of the triangles of leaves that were visited lately. A leaf that has been replaced by another
 * one is computed again at its next visit. The volumes are the kernels' leaf_volumes; only their size is known here. */
enum { LEAF_CACHE_SIZE = 128, LEAF_VOLUME_FLOATS = (4 * KDOP_AXES + 2 * BOX_AXES) * LANES };

typedef struct leaf_cache {
    uint32_t tags[LEAF_CACHE_SIZE]; /* 1 + the leaf that is stored there; 0: none */
    float (*volumes)[LEAF_VOLUME_FLOATS];
} leaf_cache;

/* The work of one thread: its share of the open block pairs, and its batch of results. */
typedef struct traversal_worker {
    _Alignas(CACHE_LINE_SIZE) block_pair *stack;
    size_t stack_count, stack_capacity;
    triangle_pair *pairs;
    uint32_t pair_count;
    uint64_t boxes_tested, adjacent; /* adjacent: pairs with overlapping volumes that were left out */
    uint64_t pairs_found;            /* by the caller */
    double search_ms, consume_ms;    /* time of filling batches since the begin; of the rest, by the caller */
    leaf_cache cache;
    bool out_of_memory;
} traversal_worker;

/* The most that one visit adds: the pairs of 64 leaf pairs, and 64 pairs of children and 8 children with themselves. */
enum { TRAVERSAL_PAIRS_PER_VISIT = 64 * 64, TRAVERSAL_PUSHES_PER_VISIT = 72 };
enum { TRAVERSAL_BATCH_SIZE = 4 * TRAVERSAL_PAIRS_PER_VISIT, TRAVERSAL_BATCH_ENOUGH = 1024 };

typedef struct traversal {
    cscd_context *context;
    const bvh *bvh;
    traversal_pass pass;
    bool whole;                /* set by the caller: pairs of inactive triangles are found as well */
    bool skips_inactive;       /* this pass does not find pairs of inactive triangles */
    collapsed_trees collapsed; /* set by the caller, after bvh_mark_collapsed */
    traversal_worker *workers; /* one per thread of the context */
    uint32_t worker_count;
    uint32_t
        busy_workers; /* the workers that share this traversal are the first ones; 1: it is too small to be shared */

    /* Open block pairs. Those from next_share on have not been taken by a worker yet. */
    block_pair *shares;
    uint32_t share_count;
    atomic_uint next_share;
    uint32_t tasks_wanted; /* TRAVERSAL_TASKS_WANTED, or fewer for tests: then tasks are large */
} traversal;

/* On failure the traversal holds nothing. */
cscd_status traversal_create(cscd_context *context, traversal *out);
void traversal_destroy(traversal *t);

/* Starts a pass at the root of the hierarchy, which must be up to date. */
void traversal_begin(traversal *t, const bvh *hierarchy, traversal_pass pass);

/* Fills the worker's batch with some pairs that no worker has found yet, usually TRAVERSAL_BATCH_ENOUGH or a few more.
 * Each worker runs on one thread at a time, independently of the others. False: the batch is empty, because only pairs
 * that other workers work on are left, or because the call is cancelled. The union of all batches, and the sum of
 * boxes_tested, are the same for any worker count. */
bool traversal_fill(traversal *t, uint32_t worker);

/* OUT_OF_MEMORY: a stack could not grow, and pairs are missing. */
cscd_status traversal_status(const traversal *t);

/* Fills the batches of all workers at once, as full as they get. *more is false when every batch is empty. Between two
 * rounds the caller consumes the batches. */
cscd_status traversal_round(traversal *t, bool *more);

/* Returns the share of the block pairs that workers have taken; 0 as long as it is not known. */
double traversal_done(const traversal *t);

uint64_t traversal_boxes_tested(const traversal *t);

/* A pass may be cut into tasks instead, numbered by what the trees alone say: the same ones in the same order for any
 * worker count. Each finds its pairs in an order of its own, whichever worker does it. */
enum {
    TRAVERSAL_TASKS_WANTED = 1024,
    TRAVERSAL_TASKS_MAX = TRAVERSAL_TASKS_WANTED + TRAVERSAL_PUSHES_PER_VISIT
};

/* Starts a pass at the root of the hierarchy, of t->share_count tasks. OUT_OF_MEMORY: a stack could not grow. */
cscd_status traversal_begin_tasks(traversal *t, const bvh *hierarchy, traversal_pass pass);

/* Lets a worker begin a task, and forget the rest of the one before. */
void traversal_begin_task(traversal *t, uint32_t worker, uint32_t task);

/* Fills the worker's batch with the next pairs of its task. False: there are none left, or the status says why. */
bool traversal_fill_from_task(traversal *t, uint32_t worker);

/* ---- the skin ---------------------------------------------------------------------------------------------- */

/* While trees have moved little since a moment, pairs that were found then with volumes widened by as much are still all
 * pairs.
 *
 * The skin of a Verlet list (Verlet 1967) for triangles. At the reference every vertex has a place in the frame of its tree.
 * Later it is off by at most `distance`, the same for all. Signs of triangles last while, besides, two corners of one
 * triangle are off by almost the same. Frames move linearly within an interval, so both bounds hold throughout if they hold at
 * both ends. Where corners in a leaf differ by more than its `stretch` at either end, its signs are computed for the interval. */

/* Everything is a copy, so that trees may be rebuilt or freed. */
typedef struct bvh_skin {
    cscd_context *context;
    const struct bvh_kernels *kernels;
    uint32_t tree_count, record_count, leaf_count, chunk_count;
    struct skin_tree *trees;
    uint32_t *vertices; /* per record */
    float (*items)[8];  /* per record: x y z . at the reference, and how far it is from there: x y z . */
    struct skin_leaf *leaves;
    float *stretches; /* per leaf, scaled and squared */
    bool *stray_at_start,
        *stray_at_end; /* per leaf: its corners differ by more at that end of the interval */
    bool *within;      /* per SKIN_LEAVES leaves: the outcome */
    struct skin_chunk *chunks;
    double scale;
    double distance; /* a length */
} bvh_skin;

/* Makes room for the records and leaves of trees. The skin is zeroed before its first call; its memory is used again. False: no
 * memory, and nothing holds. */
bool bvh_skin_reserve(bvh_skin *s, const bvh *hierarchy);

/* Returns what bvh_orient has to be told, so that bvh_skin_set can follow it. */
orientation_lasting bvh_skin_lasting(const bvh_skin *s, const bvh *hierarchy, double distance,
                                     double least_stretch);

/* Takes the places of records from the last refit, which was to a moment, and leaves and detector points from the last
 * bvh_orient. */
void bvh_skin_set(bvh_skin *s, const bvh *hierarchy, double distance);
void bvh_skin_free(bvh_skin *s);

/* Tells whether all vertices, which are near their places at the start of an interval, stay there to its end, and all
 * signs last. */
bool bvh_skin_holds(bvh_skin *s, const double *x0, const double *x1);

/* Goes on to the end of the interval of the last bvh_skin_holds, where the next one starts. */
void bvh_skin_take(bvh_skin *s);

/* Writes the detector points of regions in the interval of the last bvh_skin_holds. */
void bvh_skin_points(const bvh_skin *s, double (*points)[2][3]);

/* The greatest motion of vertices in the frames of trees, and by how much the corners of a leaf differ in this. */
typedef struct skin_motion {
    double distance, stretch; /* lengths */
} skin_motion;

/* Estimates the motion from x0 to x1, by samples: no bound. */
skin_motion bvh_skin_estimate(const bvh *hierarchy, const double *x0, const double *x1);
