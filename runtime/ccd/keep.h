/* Leaving pairs out of a list, in place. */
#pragma once

#include "runtime/ccd/ccd_kernels.h"

/* Pair i moves up to place kept, and stays if kept_now is 1: without branches, for which stay is anyone's
 * guess. */
static inline uint32_t keep_pair(feature_pairs *pairs, uint32_t i, uint32_t kept_now, uint32_t kept) {
    pairs->a[kept] = pairs->a[i];
    pairs->b[kept] = pairs->b[i];
    return kept + kept_now;
}
