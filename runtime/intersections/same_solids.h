/* Which bodies are two copies of one solid: their surfaces lie on each other wherever one could be inside the other, and both
 * contain the same. No curve and no depth tells, since nothing of one is within the other. */
#pragma once

#include "runtime/intersections/overlaps.h"

#include <cscd/depths.h>
#include <cscd/intersections.h>

/* The memory of all calls; begins with nothing but the context set. */
typedef struct same_solids {
    cscd_context *context;
    const surface_bodies *bodies; /* of the surface asked last */
    uint64_t *pairs, *spare;      /* bodies a < b, a in the upper half; ascending */
    size_t count, capacity;
} same_solids;

void same_solids_free(same_solids *s);

/* Finds them. `overlaps` is only asked where bodies share area, and no depth says that one is within the other. OUT_OF_MEMORY has
 * no sentence. */
cscd_status same_solids_find(same_solids *s, const surface_cuts *found, const cscd_intersection_pair *pairs,
                             size_t pair_count, const cscd_depths *depths, overlap_finder *overlaps,
                             const left_out_pairs *left_out);

/* Are two bodies copies of one solid? */
bool same_solids_have(const same_solids *s, uint32_t a, uint32_t b);
