/* Distances from bodies, and how often they wind around a point, triangle by triangle. */
#pragma once

#include "tests/support/intersections/body_rig.h"

double body_distance(const body_rig *r, uint32_t body, const double x[3]);

/* The winding number around a generic point. */
int body_number(const body_rig *r, uint32_t body, const double x[3]);
