/* How far each vertex may go, on any path, before two features can come together. */
#pragma once

#include "runtime/solver/near_pairs.h"

/* Writes a bound for each vertex, a number of the given scalar, and lists the pairs whose vertices have a bound of 0, in
 * the detector's memory. docs/theory/displacement-bounds.md, lemma 3, says what the bounds promise. */
cscd_status displacement_bounds_find(cscd_detector *d, const double *x0, double search_radius,
                                     cscd_scalar scalar, double *bounds, cscd_displacement_bounds *out);
