/* A detector's knowledge of the start of its next interval. A call that fails puts it back. */
#pragma once

#include "runtime/culling/culling.h"
#include "runtime/detector/verlet_list.h"
#include "runtime/intersections/intersections.h"
#include "src/mesh/surface.h"

/* A snapshot of what a call that is cancelled or fails must restore.
 *
 * Such a call may have found contacts and tainted triangles. States are those of its start until it succeeds, and an
 * unfinished check records nothing. So the states never promise too much, and the next call would be sound without a
 * rollback. But it might do more work, or report other contacts in mode EARLIEST, than it would have done without
 * the failure. That is why the states are put back. Trees that the call has rebuilt stay, because they serve the
 * repetition as well. */
typedef struct rollback {
    uint8_t *triangles;          /* start_states.triangles; NULL: nothing is restored */
    component_start *components; /* start_states.of */
    bool vouched;
    uint32_t intervals_unmeasured;
} rollback;

/* In a context without a progress function, where calls fail only because memory runs out or a callback has called
 * cscd_context_cancel, it takes no memory, and nothing is restored. On failure the caller frees what was allocated. */
cscd_status rollback_create(const cscd_mesh *mesh, rollback *out);
/* Takes the memory after all, where calls fail for other reasons, too. On failure nothing changes. */
cscd_status rollback_reserve(const cscd_mesh *mesh, rollback *r);
void rollback_free(cscd_context *context, rollback *r);

void rollback_save(rollback *r, const start_states *starts, const bvh_rebuild *trees);
void rollback_restore(const rollback *r, start_states *starts, bvh_rebuild *trees);

/* The knowledge of the positions that the next interval begins at. */
typedef struct start_knowledge {
    start_states starts;
    static_check check;
    collapsed_components collapsed; /* at the moment of the last check, or at an end of the last interval */
    verlet_list verlet;
    rollback before; /* the current call */
} start_knowledge;
