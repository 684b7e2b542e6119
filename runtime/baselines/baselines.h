/* Methods to compare with, as stages of a step: patches that cannot touch themselves, and the published pipelines. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* Hide the pairs within patches that cannot touch themselves. Both lose no contact, whatever the start: ICCD (Tang et al. 2009),
 * corrected, and normal cones with contours that stay star-shaped, in linear time (docs/theory/iccd.md). */
extern const pair_hider iccd_hider, cones_hider;

/* The published pipelines, from the update of their trees to contacts: culling by detector points (Yeh 2012, chapter 4), and ICCD as
 * the thesis has it (section 5.1), on the same trees and tests. */
extern const own_search detector_based_search, iccd_search;
