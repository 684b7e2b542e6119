/* How well regions hang together where the material is soft, triangle by triangle: what method auto compares plans by. */
#pragma once

#include "preprocess/regions/region_motion.h"

/* Finds the blindness of each triangle for what lies between it and the point of its region, as in soft_paths.h: 0 where the way within
 * the region is stiff. It begins at the triangle that is nearest to the point; what no way leads to counts as far beyond. stiffness:
 * of each triangle, positive and finite. The scene holds all triangles of the mesh. */
cscd_status soft_ways_find(const region_scene *scene, const double *stiffness, double *ways);
