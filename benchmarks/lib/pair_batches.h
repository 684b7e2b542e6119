/* Sends pairs of features through the feature queue, as a step does: in batches of any size, on every level of
 * vector instructions that the processor has. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"
#include "src/core/system.h"

enum { PAIR_BATCH_LEVELS = SIMD_LAST, PAIR_BATCH_MAX = FEATURE_LIST_CAPACITY - 1 };

typedef struct query_answer {
    bool touching;
    elementary_contact hit; /* zeros where they do not touch */
} query_answer;

typedef struct pair_batches {
    cscd_context *contexts[PAIR_BATCH_LEVELS];  /* NULL: the processor lacks this level */
    contact_worker *workers[PAIR_BATCH_LEVELS]; /* contacts, and which level decided how many pairs */
    cscd_contact *found[PAIR_BATCH_LEVELS];     /* the contacts of each worker, sorted */
    cscd_mesh mesh;                             /* only triangles and edges */
    const double *x0, *x1;
    uint32_t (*pairs)[2]; /* in the order in which they are tested */
    size_t pair_capacity, query_capacity;
    double *query_points[2];
    uint32_t (*query_triangles)[3], (*query_edges)[2];
    uint64_t random;
} pair_batches;

/* False when memory runs out; what is open is then closed. */
bool pair_batches_open(pair_batches *b);
/* The same with one level alone, the highest: pairs are decided once, and nothing is compared. */
bool pair_batches_open_best(pair_batches *b);
void pair_batches_close(pair_batches *b);

/* The highest level that this processor has. */
int pair_batches_best_level(const pair_batches *b);

/* Decides vertices pairs[i][0] and triangles pairs[i][1], or two edges, in random order and in batches of random
 * sizes, on each level. Returns the contacts, sorted by a and b, in memory that lasts until the next call; NULL
 * when two levels differ in a bit of a contact or in a count, or when memory runs out: then *problem says so. */
const cscd_contact *pair_batches_decide(pair_batches *b, const feature_source *source, cscd_contact_kind kind,
                                        const uint32_t (*pairs)[2], size_t count, size_t *contact_count,
                                        const char **problem);

/* Does the same for queries, which have no mesh; the answers come in the order of the queries. False:
 * see *problem. */
bool pair_batches_decide_queries(pair_batches *b, cscd_contact_kind kind, const elementary_query *queries,
                                 size_t count, query_answer *answers, const char **problem);

/* For timing: turns query i into pair i, and decides pairs begin to end - 1 on one level in one batch, after
 * emptying the worker. */
bool pair_batches_load(pair_batches *b, cscd_contact_kind kind, const elementary_query *queries,
                       size_t count);
void pair_batches_run(pair_batches *b, int level, cscd_contact_kind kind, size_t begin, size_t end);

/* Returns how many pairs each elementary level decided in the last call, on the lowest level of vector
 * instructions. */
const uint64_t *pair_batches_decided(const pair_batches *b);
