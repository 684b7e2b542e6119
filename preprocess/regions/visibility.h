/* Places detector points, and finds how much of its region each of them sees from inside. */
#pragma once

#include "src/mesh/mesh.h"

/* The centroid of each region's surface: of its triangles' centroids, weighted by area (equally in a region
 * without area). 3 doubles per region. */
cscd_status detector_points_from_regions(const cscd_mesh *mesh, const double *positions,
                                         const uint32_t *region_of_triangle, uint32_t region_count,
                                         double *points);

/* Writes for each region the share of its area whose triangles face the region's point: S+, (p0 - d) . n > 0.
 * It is 0 in a region without area. */
cscd_status visible_shares(const cscd_mesh *mesh, const double *positions, const uint32_t *region_of_triangle,
                           uint32_t region_count, const double *points, double *shares);

/* (p0 - d) . n of one triangle and the point d: positive where the point sees its inner side. */
double orientation_value(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                         const double point[3]);
