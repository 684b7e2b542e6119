/* Gives triangles and vertices to objects and their parts. */
#pragma once

#include "src/mesh/partition.h"
#include "src/mesh/plan.h"

/* Returns a partition without cells, or NULL when out of memory. plan is NULL or a plan of the mesh. A vertex
 * belongs to the part with most of its triangles, and of equal ones to that with the smaller number. */
cscd_partition *partition_of_parts(const cscd_mesh *mesh, const cscd_plan *plan);
