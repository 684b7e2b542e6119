/* Takes parts as spheres of their areas: a part gets as many cells as other spheres can touch it at once. */
#pragma once

#include "src/mesh/partition.h"

/* How many spheres of radius `other` can touch one of this radius at once, at most `most` and at least 1. Of
 * equal spheres (within 1 %) it is 12. Of others it is as many as their shadows fit on the sphere by area,
 * which are circles of half angle asin(other / (radius + other)) seen from its centre; for equal spheres that
 * would be 14. External for its test, which compares it with numbers worked out by hand. */
uint32_t kissing_number(double radius, double other, uint32_t most);

/* Writes the radii of spheres that have the areas of the parts. */
void find_radii(const cscd_partition *partition, const double *positions, double *radii);

/* Counts the cells of each part: the number that the options give; else 1 for each of two convex objects that
 * are all there are, 1 for a part that is not watched, and for others the number of spheres, of the size of
 * the smallest part that is watched with it, that touch it at once. A part has at most as many cells as
 * vertices, and at most the options' cells_max. convex has an element per part. */
cscd_status count_cells(const cscd_partition *partition, const double *radii, const bool *convex,
                        uint32_t *counts);
