/* Charge equalized: each triangle's rank in its component, which pictures and reports show as a colour. */
#pragma once

#include "cscd/cscd.h"

/* One double per triangle, to be freed: 0 for the least charge of the component, 1 for the most, equal
 * charges equal; 0 where the component has one triangle only. NULL: out of memory. */
double *charge_ranks(const cscd_plan *plan, const cscd_mesh *mesh);
