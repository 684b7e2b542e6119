/* Pairs of features that wait for their elementary test, which takes eight at a time. */
#pragma once

#include "runtime/bvh/kernels.h"

/* Whoever adds up to FEATURE_QUEUE_BURST pairs of a kind asks once whether there is room for them. */
enum { FEATURE_QUEUE_CAPACITY = 512, FEATURE_QUEUE_BURST = 16 };

/* Vertex a[i] and triangle b[i], or edges a[i] < b[i]. The slack is for what kernels fill up. */
typedef struct feature_list {
    uint32_t count;
    uint32_t a[FEATURE_QUEUE_CAPACITY + FEATURE_QUEUE_BURST], b[FEATURE_QUEUE_CAPACITY + FEATURE_QUEUE_BURST];
} feature_list;

/* Of one thread. */
typedef struct feature_queue {
    feature_list vf, ee;
} feature_queue;

/* Writes a pair to place count and returns the count with it if `kept` is 1, without it if 0: no branch. */
static inline uint32_t feature_list_put(feature_list *list, uint32_t count, uint32_t a, uint32_t b,
                                        uint32_t kept) {
    list->a[count] = a;
    list->b[count] = b;
    return count + kept;
}

static inline bool feature_list_full(const feature_list *list) {
    return list->count + FEATURE_QUEUE_BURST > FEATURE_QUEUE_CAPACITY;
}

struct swept_interval;
struct contact_lane;

/* What the kernels read of an interval. */
feature_source feature_queue_source(const struct swept_interval *interval);

/* Decides all pairs of one list, or of both, and adds contacts and counts to the lane. */
void feature_queue_decide_vf(const struct swept_interval *interval, struct contact_lane *lane);
void feature_queue_decide_ee(const struct swept_interval *interval, struct contact_lane *lane);
