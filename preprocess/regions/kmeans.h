/* K-means regions: vertices in k clusters, triangles by the fewest edges to a cluster's centre. */
#pragma once

#include "src/mesh/mesh.h"

/* Lloyd's iteration over the vertices of each component from random vertices, at most 200 rounds; a centroid
 * is free and need not be a vertex. Then each triangle goes to the centroid whose anchor, the nearest vertex
 * of its cluster, is fewest edges away; ties go to the first. What that leaves apart joins a neighbour.
 *
 * k is shared out over the components by their vertices, at least one each, at most one per vertex: so
 * *region_count may be more than k (as many components) or less (few vertices; a centroid whose triangles
 * are all nearer to others has no region). detector_points has room for 3 * kmeans_capacity(mesh, k).
 * Regions are connected, lie in one component each and are numbered by their first triangles. The same seed
 * gives the same regions. INVALID_ARGUMENT: k is 0. Outputs are written on success only. */
cscd_status regions_kmeans(const cscd_mesh *mesh, const double *positions, uint32_t k, uint32_t seed,
                           uint32_t *region_of_triangle, uint32_t *region_count, double *detector_points);

/* The most regions that there can be: k, but not more than vertices, and one per component at least. */
uint32_t kmeans_capacity(const cscd_mesh *mesh, uint32_t k);
