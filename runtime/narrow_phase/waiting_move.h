/* Waiting pairs that move over to another mesh, and those that the change itself parts. */
#pragma once

#include "runtime/narrow_phase/exclusions_move.h"
#include "runtime/narrow_phase/waiting_pairs.h"

/* What is left out in the old mesh, as the detector sees it. */
typedef struct left_out_before {
    const cscd_mesh *mesh;
    const exclusions *exclusions;
    const pair_rules *rules;
} left_out_before;

/* A pair that waits becomes all pairs that came from its two features. Neighbours that the change has parted, because
 * their common vertex, or the seam between them, came apart, are added to *out as torn. Where obstacles become free,
 * what they left out is uncovered. mesh: the new one. OUT_OF_MEMORY without a sentence: *out holds nothing. */
cscd_status waiting_pairs_move(const waiting_pairs *w, const left_out_before *before, const cscd_mesh *mesh,
                               const cscd_mesh_change *change, waiting_pairs *out);

/* Copies all of it; mesh: the same one in the context of the copy. The same of failure. */
cscd_status waiting_pairs_copy(const waiting_pairs *w, const cscd_mesh *mesh, waiting_pairs *out);
