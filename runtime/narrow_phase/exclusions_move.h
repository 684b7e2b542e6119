/* Exclusions that move over to another mesh, or are copied. */
#pragma once

#include "runtime/narrow_phase/exclusions.h"
#include "src/mesh/mesh_heirs.h"

/* A seam joins what has become of its vertices: of vertices that came apart, the first. A pair of ignored triangles
 * becomes all pairs of triangles that came from the two. Pairs do not wait. OUT_OF_MEMORY without a sentence: *out is untouched. */
cscd_status exclusions_move(const exclusions *e, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            exclusions *out);

/* The same of what was left out before, where all vertices that came from one count as it did. */
cscd_status exclusions_move_former(const exclusions *e, const cscd_mesh *mesh, const cscd_mesh_change *change,
                                   exclusions *out);

/* Copies all of it but the waiting pairs; mesh: the same one in the context of the copy. On failure *out is untouched. */
cscd_status exclusions_copy(const exclusions *e, const cscd_mesh *mesh, exclusions *out);
