/* What it costs to cut along an edge: its length, and less where the charge is low. */
#pragma once

#include "preprocess/regions/regions.h"

/* Finds the weight of each edge. equalized: of each triangle. */
void weigh_edges(const cscd_mesh *mesh, const double *positions, const double *equalized,
                 const region_options *options, double *weights);
