/* What intersections, curves and depths say of each pair of parts. */
#pragma once

#include "runtime/intersections/same_solids.h"
#include "src/core/memory_budget.h"
#include "src/mesh/part_labels.h"

#include <cscd/intersections.h>

/* A pair of parts, and what belongs to it: a pair of triangles, a piece of a curve, or a depth. */
typedef struct part_key {
    uint64_t parts; /* the smaller one in the upper half */
    uint64_t item;  /* its place in the list; of a piece behind that of its curve in the upper half */
} part_key;

/* The memory of all calls; begins with zeros. */
typedef struct part_summer {
    part_key *keys, *spare_keys;
    size_t key_capacity;
    cscd_part_pair *items;
    size_t item_capacity;
    bool *marks; /* per triangle; all are false between calls. NULL before the first */
} part_summer;

void part_sums_free(cscd_context *context, part_summer *s);

/* Sums up what was found. same: the copies among the bodies; NULL: nobody has asked. *out lives until the next call.
 * OUT_OF_MEMORY has no sentence, and may mean that the sums do not fit the budget. */
cscd_status part_sums_run(part_summer *s, const cscd_mesh *mesh, const part_labels *labels,
                          const cscd_intersection_pairs *found, const same_solids *same,
                          memory_budget *budget, cscd_part_pairs *out);
