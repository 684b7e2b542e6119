/* Objects and their parts: which triangles and vertices belong to each. */
#pragma once

#include "src/mesh/partition.h"
#include "src/mesh/plan.h"

/* A partition without cells. plan: NULL, or one of the mesh. A vertex belongs to the part with most of its
 * triangles, the smaller number where two have as many. NULL when out of memory. */
cscd_partition *partition_of_parts(const cscd_mesh *mesh, const cscd_plan *plan);
