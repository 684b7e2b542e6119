/* Curves along which surfaces touch, and no more. */
#pragma once

#include "runtime/intersections/curves.h"

/* Marks those of the joiner's last call. pairs: those that it was given. */
void touching_curves_mark(curve_joiner *j, const named_surface *s, const cscd_intersection_pair *pairs,
                          const cscd_patches *patches, const cscd_depths *depths);
