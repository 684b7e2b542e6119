/* Self-traversal of the BVH: batches of triangle pairs whose volumes overlap, without recursion. */
#pragma once

#include "runtime/bvh/bvh.h"

#include <stdatomic.h>

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
    TRAVERSAL_KEPT, /* all that the flags keep and that are not hidden, but those of inactive triangles */
    TRAVERSAL_NEWLY_KEPT, /* those of them that the flags did not keep before */
    TRAVERSAL_UNPROVEN    /* those of two unproven triangles, active or not */
} traversal_pass;

/* What a pass does with trees that hold nothing but collapsed components. */
typedef enum collapsed_trees {
    COLLAPSED_FOUND,      /* it knows of none */
    COLLAPSED_PAIRS_LEFT, /* pairs of two such trees, or of one with itself, are not found */
    COLLAPSED_LEFT        /* no pair of such a tree is found */
} collapsed_trees;

/* Keeps the volumes of the triangles of leaves that were visited lately. A leaf that has been replaced by another
 * one is computed again at its next visit. The volumes are the kernels' leaf_volumes; only their size is known here. */
enum { LEAF_CACHE_SIZE = 128, LEAF_VOLUME_FLOATS = (4 * KDOP_AXES + 2 * BOX_AXES) * LANES };

typedef struct leaf_cache {
    uint32_t tags[LEAF_CACHE_SIZE]; /* 1 + the leaf that is stored there; 0: none */
    float (*volumes)[LEAF_VOLUME_FLOATS];
} leaf_cache;

/* The work of one thread: its share of the open block pairs, and its batch of results. */
typedef struct traversal_lane {
    _Alignas(CACHE_LINE_SIZE) block_pair *stack;
    size_t stack_count, stack_capacity;
    triangle_pair *pairs;
    uint32_t pair_count;
    uint64_t boxes_tested, adjacent; /* adjacent: pairs with overlapping volumes that were left out */
    uint64_t pairs_found;            /* by the caller */
    double search_ms, consume_ms;    /* time of filling batches since the begin; of the rest, by the caller */
    leaf_cache cache;
    bool out_of_memory;
} traversal_lane;

/* The most that one visit adds: the pairs of 64 leaf pairs, and 64 pairs of children and 8 children with themselves. */
enum { TRAVERSAL_PAIRS_PER_VISIT = 64 * 64, TRAVERSAL_PUSHES_PER_VISIT = 72 };
enum { TRAVERSAL_BATCH_SIZE = 4 * TRAVERSAL_PAIRS_PER_VISIT, TRAVERSAL_BATCH_ENOUGH = 1024 };

typedef struct traversal {
    cscd_context *context;
    const bvh *bvh;
    traversal_pass pass;
    bool whole;          /* set by the caller: pairs of inactive triangles are found as well */
    bool skips_inactive; /* pairs of inactive triangles are not found by this pass */
    collapsed_trees
        collapsed; /* set by the caller, who has marked them (bvh_mark_collapsed), if they are not found */
    traversal_lane *lanes; /* one per thread of the context */
    uint32_t lane_count;
    uint32_t
        busy_lanes; /* the first busy_lanes lanes share this traversal; 1: it is too small to be shared */

    /* Open block pairs. Those from next_share on have not been taken by a lane yet. */
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

/* Fills the lane's batch with some pairs that no lane has found yet, usually TRAVERSAL_BATCH_ENOUGH or a few more.
 * Each lane runs on one thread at a time, independently of the others. False: the batch is empty, because only pairs
 * that other lanes work on are left, or because the call is cancelled. The union of all batches, and the sum of
 * boxes_tested, are the same for any lane count. */
bool traversal_fill(traversal *t, uint32_t lane);

/* OUT_OF_MEMORY: a stack could not grow, and pairs are missing. */
cscd_status traversal_status(const traversal *t);

/* Fills the batches of all lanes at once, as full as they get. *more is false when every batch is empty. Between two
 * rounds the caller consumes the batches. */
cscd_status traversal_round(traversal *t, bool *more);

/* Returns the share of the block pairs that lanes have taken; 0 as long as it is not known. */
double traversal_done(const traversal *t);

uint64_t traversal_boxes_tested(const traversal *t);

/* ---- in tasks ------------------------------------------------------------------------------------------ */

/* A pass may be cut into tasks instead, numbered by what the trees alone say: the same ones in the same order for any
 * lane count. Each finds its pairs in an order of its own, whichever lane does it. There are at most so many. */
enum {
    TRAVERSAL_TASKS_WANTED = 1024,
    TRAVERSAL_TASKS_MAX = TRAVERSAL_TASKS_WANTED + TRAVERSAL_PUSHES_PER_VISIT
};

/* Starts a pass at the root of the hierarchy, of t->share_count tasks. OUT_OF_MEMORY: a stack could not grow. */
cscd_status traversal_begin_tasks(traversal *t, const bvh *hierarchy, traversal_pass pass);

/* Lets a lane begin a task, and forget the rest of the one before. */
void traversal_begin_task(traversal *t, uint32_t lane, uint32_t task);

/* Fills the lane's batch with the next pairs of its task. False: there are none left, or the status says why. */
bool traversal_fill_from_task(traversal *t, uint32_t lane);
