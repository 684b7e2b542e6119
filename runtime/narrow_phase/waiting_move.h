/* Waiting pairs that move over to another mesh, and those that the change itself parts. */
#pragma once

#include "runtime/narrow_phase/exclusions_move.h"
#include "runtime/narrow_phase/waiting_pairs.h"

/* A pair that waits becomes all pairs that came from its two features. Neighbours that the change has parted, because
 * their common vertex, or the seam between them, came apart, are added to *out as torn. e: what is left out in the old
 * mesh; mesh: the new one. OUT_OF_MEMORY without a sentence: *out holds nothing. */
cscd_status waiting_pairs_move(const waiting_pairs *w, const exclusions *e, const cscd_mesh *mesh,
                               const cscd_mesh_change *change, waiting_pairs *out);

/* Copies all of it; mesh: the same one in the context of the copy. The same of failure. */
cscd_status waiting_pairs_copy(const waiting_pairs *w, const cscd_mesh *mesh, waiting_pairs *out);
