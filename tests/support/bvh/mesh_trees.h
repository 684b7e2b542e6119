/* Trees as method SINGLE has them, at one moment. */
#pragma once

#include "runtime/bvh/bvh.h"

/* Builds one tree per component, and refits them to the positions. */
void mesh_trees_build(const cscd_mesh *mesh, const double *positions, int axis_count, bvh *out);
