/* Culling and start states that move over to another mesh: untouched components keep what they have. */
#pragma once

#include "runtime/bvh/bvh_move.h"
#include "runtime/culling/culling.h"
#include "runtime/culling/start_state.h"
#include "src/mesh/mesh_change.h"

/* What becomes of regions: those of untouched components stay in their order; then each other component is one. */
typedef struct region_move {
    uint32_t *to_new;        /* per old region; UINT32_MAX: gone */
    uint32_t *of_components; /* per component of the new mesh its region, UINT32_MAX: it is untouched */
    uint32_t old_count, kept_count; /* kept: regions of untouched components, which come first */
    fresh_region *fresh;            /* all others */
    uint32_t fresh_count;
} region_move;

/* c: of the old mesh, without regions of several components. On failure *out holds nothing. */
cscd_status region_move_find(cscd_context *context, const culling *c, const cscd_mesh_change *change,
                             region_move *out);
void region_move_free(cscd_context *context, region_move *m);

/* Nothing is culled yet. mesh: the new one; on failure *out holds nothing. */
cscd_status culling_move(const culling *c, const cscd_mesh *mesh, const cscd_mesh_change *change,
                         const region_move *regions, culling *out);

/* Triangles of untouched components keep their states, and their vertices the positions seen last; all others are
 * UNKNOWN. mesh: the new one; on failure *out holds nothing. */
cscd_status start_states_move(const start_states *s, const cscd_mesh *mesh, const cscd_mesh_change *change,
                              start_states *out);
