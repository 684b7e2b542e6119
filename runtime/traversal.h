/* Self-traversal of the tree: batches of triangle pairs whose volumes overlap, without recursion. */
#ifndef CSCD_TRAVERSAL_H
#define CSCD_TRAVERSAL_H

#include "runtime/bvh.h"

/* A potentially colliding pair of different triangles. */
typedef struct triangle_pair {
    uint32_t a, b;
} triangle_pair;

/* Two nodes whose subtrees are still to be compared; the same node twice: with itself. */
typedef struct node_pair {
    uint32_t a, b;
} node_pair;

/* Which pairs of triangles are looked for, of those whose volumes overlap: all; those that bvh_mark's marks
 * leave; those that were culled before, and are not by bvh_mark_fresh's; those of two suspects, by
 * bvh_mark_suspects; those that do not lie below one node that patches_seal has marked. */
typedef enum traversal_pass {
    TRAVERSAL_ALL,
    TRAVERSAL_KEPT,
    TRAVERSAL_FRESH,
    TRAVERSAL_SUSPECTS,
    TRAVERSAL_UNSEALED
} traversal_pass;

/* What one thread works on: its share of the open node pairs and its batch of results. */
typedef struct traversal_lane {
    _Alignas(CACHE_LINE_SIZE) node_pair *stack;
    size_t stack_count, stack_capacity;
    triangle_pair *pairs;
    uint32_t pair_count;
    uint64_t boxes_tested;
    bool out_of_memory;
} traversal_lane;

enum { TRAVERSAL_BATCH_SIZE = 1 << 14 };

typedef struct traversal {
    cscd_context *context;
    const bvh *tree;
    traversal_pass pass;
    traversal_lane *lanes; /* one per thread of the context */
    uint32_t lane_count;
} traversal;

/* On failure the traversal holds nothing. */
cscd_status traversal_create(cscd_context *context, traversal *out);
void traversal_destroy(traversal *t);

/* Starts anew at the root of tree, which is already refitted, and marked unless the pass is ALL. */
void traversal_begin(traversal *t, const bvh *tree, traversal_pass pass);

/* Fills each lane's batch with up to TRAVERSAL_BATCH_SIZE pairs; false when all is done and every batch is
 * empty. Between two rounds the caller consumes the batches. The union of all batches, and the sum of
 * boxes_tested, are the same for any lane count. OUT_OF_MEMORY: a stack could not grow. */
cscd_status traversal_round(traversal *t, bool *more);

uint64_t traversal_boxes_tested(const traversal *t);

#endif
