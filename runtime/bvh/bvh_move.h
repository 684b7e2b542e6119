/* Trees that move over to another mesh, and copies of trees. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "src/mesh/mesh_change.h"

/* A region that has no tree yet, which is a component of its own. */
typedef struct fresh_region {
    uint32_t region, triangle_count, vertex_count;
    uint32_t after; /* its tree comes after that of this old region; UINT32_MAX: at the end */
} fresh_region;

/* What has become of the numbers of trees that are kept. */
typedef struct bvh_move {
    const cscd_mesh *mesh; /* the new one */
    const cscd_mesh_change *change;
    const uint32_t *regions; /* per old one the new one; UINT32_MAX: its tree is not kept */
    uint32_t old_region_count, region_count;
    const fresh_region *fresh; /* all regions that no old one becomes */
    uint32_t fresh_count;
} bvh_move;

/* Copies the trees that are kept, and makes room for the others, which are missing: only bvh_finish, bvh_move_over and
 * bvh_free may be called then. There are no records, unless bvh_take_records gives them. f may have missing trees itself.
 * On failure *out is untouched. */
cscd_status bvh_move_over(const bvh *hierarchy, const bvh_move *move, bvh *out);

/* Takes the memory for records from trees that are about to be freed, if it is enough. */
void bvh_take_records(bvh *hierarchy, bvh *from);

/* Copies everything; mesh: the same one in the context of the copy. On failure *out is untouched. */
cscd_status bvh_copy(const bvh *hierarchy, const cscd_mesh *mesh, bvh *out);
