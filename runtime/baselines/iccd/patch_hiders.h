/* Patches that cannot touch themselves as a stage of a step: the pairs within them are hidden. Both lose no contact, whatever the
 * start. */
#pragma once

#include "runtime/culling/culling.h"

/* ICCD (Tang et al. 2009), corrected (docs/theory/iccd.md). */
extern const pair_hider iccd_hider;

/* Normal cones with contours that stay star-shaped, in linear time (docs/theory/cones.md). */
extern const pair_hider cones_hider;
