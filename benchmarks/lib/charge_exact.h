/* Bodies of models/shapes as conductors whose charge is known otherwise. */
#pragma once

#include "models/shapes/catalogue.h"

/* At potential 1 in Gaussian units; NAN: unknown. That of the cube is known to 14 digits. */
double exact_capacitance(body_kind kind);

bool has_exact_density(body_kind kind);

/* The charge per area at the place of the surface that is nearest to the point, or in the same direction. */
double exact_density(body_kind kind, const double point[3]);
