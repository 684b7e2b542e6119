/* Selects the cuts that pay: those after which detector points see more. */
#pragma once

#include "preprocess/regions/cut_list.h"

/* Starts from one region per component and makes cuts, one by one. A cut counts when no region is left below
 * part_share of the component's area, when the visible area does not fall, and when the area that is firmly
 * visible (at 6 degrees or more to the line of sight) rises by gain times the component's area or more; of
 * those within gain of the best the cheapest is made. gain < 0: only the first condition counts. In a
 * component that is inside out (of negative volume) a triangle is visible from its outer side.
 * regions: of each triangle, numbered from 0 in each component. */
cscd_status select_cuts(const cscd_mesh *mesh, const dual_graph *graph, const double *positions,
                        const double *areas, const cut_list *cuts, double gain, double part_share,
                        uint32_t *regions);
