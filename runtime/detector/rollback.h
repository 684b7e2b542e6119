/* Snapshot of what a call that is cancelled or fails must restore.
 *
 * Such a call has found some contacts and tainted triangles, whose states are those of the start until the call succeeds;
 * a check that was left records nothing. So the states say at most too little, and the next call is as sound as ever. But
 * it might do more, or report other contacts in mode EARLIEST, than it would without the failure: that is why they are put
 * back. Trees that the call has rebuilt stay: the repetition finds them as good as new. */
#pragma once

#include "runtime/bvh/bvh_rebuild.h"
#include "runtime/culling/start_state.h"

typedef struct rollback {
    uint8_t *triangles;          /* start_states.triangles; NULL: nothing is restored */
    component_start *components; /* start_states.of */
    bool vouched;
    uint32_t intervals_unmeasured;
} rollback;

/* Takes no memory, and restores nothing, in a context without a progress function: there a call fails for want of memory
 * only. On failure the caller frees what there is. */
cscd_status rollback_create(const cscd_mesh *mesh, rollback *out);
void rollback_free(cscd_context *context, rollback *r);

void rollback_save(rollback *r, const start_states *starts, const bvh_rebuild *trees);
void rollback_restore(const rollback *r, start_states *starts, bvh_rebuild *trees);
