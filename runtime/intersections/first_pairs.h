/* Finds the first pairs of triangles that intersect, in an order that is the same for any number of threads. */
#pragma once

#include "runtime/intersections/static_check.h"

/* Which pairs count, and how many of them are enough. */
typedef struct pair_quest {
    size_t enough; /* 1 or more */
    bool any;      /* it does not matter which ones are found */
    void *data;
    bool (*counts)(void *data, found_pair pair, pair_note note); /* asked on any thread */
    bool (*stays)(void *data, found_pair pair); /* asked afterwards, on the calling thread; NULL: all do */
} pair_quest;

/* As static_check_kinds, but ends once enough pairs have been found that count and stay. Then the lanes have these alone,
 * and of each number the same ones for any lane count: the traversal's tasks are in a fixed order, as are the pairs of a
 * task. No triangle is marked. */
cscd_status first_pairs_find(static_check *c, traversal *t, bvh *f, const double *positions,
                             const uint32_t *names, const pair_quest *quest);
