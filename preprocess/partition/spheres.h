/* Parts as spheres of their areas, and how many spheres touch one: so many cells a part gets. */
#pragma once

#include "src/mesh/partition.h"

/* How many spheres of radius `other` touch one of this radius at once, at most `most` and at least 1: 12
 * where they are equal within 1 %, else as many as their shadows, circles of half angle asin(other / (radius
 * + other)) seen from its centre, fit on a sphere by area. For equal spheres that would be 14. */
uint32_t kissing_number(double radius, double other, uint32_t most);

/* Of the spheres with the areas of parts. */
void find_radii(const cscd_partition *partition, const double *positions, double *radii);

/* Cells of each part by the options: as many as they say; or 1 for each of two convex objects that are all
 * there are, 1 where nothing is watched, else the kissing number of the smallest sphere of a part that is
 * watched. At most the part's vertices. convex: per part. */
cscd_status count_cells(const cscd_partition *partition, const double *radii, const bool *convex,
                        uint32_t *counts);
