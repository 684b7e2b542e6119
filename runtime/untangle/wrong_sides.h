/* Which vertices are on the wrong side of the curves that bound their patches. */
#pragma once

#include "runtime/untangle/lenses.h"

/* Writes patches, crossings and wrong; false: no memory. */
bool wrong_sides_find(lens_finder *f, const cscd_intersections *found);
