/* Meshes of changing scenes, and whether two meshes are the same, bit for bit. */
#pragma once

#include "src/mesh/mesh.h"
#include "tests/support/changing_mesh.h"
#include "tests/support/counting_allocator.h"

cscd_mesh *changing_scene_mesh(cscd_context *context, const changing_scene *s);

void check_same_mesh(const cscd_mesh *a, const cscd_mesh *b);
