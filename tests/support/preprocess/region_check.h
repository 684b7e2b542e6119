/* Asserts the invariants of every division into regions. */
#pragma once

#include "src/mesh/mesh.h"
#include "tests/support/models/body_of.h"

/* Checks that regions are numbered from 0 by first triangles and are connected, and that none is in two
 * components. */
void check_regions(const cscd_mesh *mesh, const uint32_t *regions, uint32_t region_count);

/* Makes the mesh of a body, in a context of its own with that many threads. */
cscd_mesh *body_mesh(const body *b, uint32_t thread_count);
void body_mesh_destroy(cscd_mesh *mesh);
