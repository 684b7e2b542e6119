/* What a plan looks like: a number or a colour for each triangle, by its charge or its region. */
#pragma once

#include "cscd/cscd.h"

/* One double per triangle, which the caller frees: the rank of the triangle's charge in its component, 0 for the
 * least and 1 for the most. Equal charges have equal ranks; in a component of one triangle the rank is 0. NULL when
 * out of memory. */
double *charge_ranks(const cscd_plan *plan, const cscd_mesh *mesh);

/* Red, green, blue per triangle: the colour of its charge's rank, dark violet for the least and yellow for the most.
 * False when out of memory. */
bool plan_colour_charge(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours);

/* The same by the density itself, from the least to the most of the component. */
bool plan_colour_density(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours);

/* Red, green, blue per triangle: the colour of its region. */
void plan_colour_regions(const cscd_plan *plan, uint32_t triangle_count, uint8_t *colours);
