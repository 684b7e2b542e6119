/* Proximities without repetitions: pairs of features whose nearest points lie on the same two vertices, or on the same
 * edge and vertex, become one item that counts them. */
#pragma once

#include "runtime/detector/contact_list.h"
#include "runtime/solver/proximity_item.h"

/* Merges `count` pairs, given by keys, into items, of which there are at most as many; *unique says how many there are.
 * They are sorted by (kind, a, b), and the same for any order of the keys. scratch is grown and kept. */
cscd_status unique_pairs_list(cscd_context *context, const proximity_scene *scene, const contact_key *keys,
                              size_t count, result_buffer *scratch, cscd_proximity *items, size_t *unique);
