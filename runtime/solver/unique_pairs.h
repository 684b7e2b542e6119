/* Lists of near pairs in which no two items have the same nearest features. */
#pragma once

#include "runtime/solver/near_pairs.h"
#include "runtime/solver/solver.h"

/* The data that items are described by. */
typedef struct proximity_scene {
    near_scene place;
    const rest_shape *rest;
    near_rules rules;
} proximity_scene;

/* Describes one of these pairs as it was found. */
void proximity_write(const proximity_scene *scene, const near_eight *found, uint32_t i, cscd_proximity *out);

/* Merges the pairs of the list into items, in items->items, which is grown and kept as scratch is. *count says how many there
 * are. They are sorted by (kind, a, b), and the same for any order of the list. */
cscd_status unique_pairs_list(cscd_context *context, const proximity_scene *scene, near_list *list,
                              result_buffer *scratch, result_buffer *items, size_t *count);
