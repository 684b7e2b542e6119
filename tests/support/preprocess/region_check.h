/* Asserts what holds for every division into regions. */
#pragma once

#include "src/mesh/mesh.h"
#include "tests/support/models/body_of.h"

/* Numbered from 0 by first triangles, connected, and none in two components. */
void check_regions(const cscd_mesh *mesh, const uint32_t *regions, uint32_t region_count);

/* The mesh of a body, in a context of its own with that many threads. */
cscd_mesh *body_mesh(const body *b, uint32_t thread_count);
void body_mesh_destroy(cscd_mesh *mesh);
