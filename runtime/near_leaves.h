/* Which leaves hold triangles whose neighbours share a vertex. */
#ifndef CSCD_NEAR_LEAVES_H
#define CSCD_NEAR_LEAVES_H

#include "runtime/forest.h"

/* Two leaves are near when a triangle that shares a vertex with one of the first shares a vertex with one of
 * the second. Elsewhere no triangle at a feature of the one shares a vertex with any of the other. Near leaf
 * i: leaves[offsets[i] .. offsets[i + 1]). */
typedef struct near_leaves {
    uint32_t *offsets, *leaves;
} near_leaves;

/* *too_many: there are more than 64 per leaf, as about a vertex in very many triangles, and *out stays
 * empty. */
cscd_status near_leaves_create(const forest *f, near_leaves *out, bool *too_many);
void near_leaves_free(cscd_context *context, near_leaves *near);

static inline bool near_leaves_hold(const near_leaves *near, uint32_t a, uint32_t b) {
    for (uint32_t i = near->offsets[a]; i < near->offsets[a + 1]; i++) {
        if (near->leaves[i] == b) return true;
    }
    return false;
}

#endif
