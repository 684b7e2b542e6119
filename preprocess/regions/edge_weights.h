/* What it costs to cut along an edge: its length, and less where the charge is low or the material soft. */
#pragma once

#include "preprocess/regions/regions.h"

/* Finds the weight of each edge. equalized: of each triangle; stiffness_shares: likewise, or NULL. */
void weigh_edges(const cscd_mesh *mesh, const double *positions, const double *equalized,
                 const double *stiffness_shares, const region_options *options, double *weights);
