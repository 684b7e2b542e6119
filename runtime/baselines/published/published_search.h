/* The published pipelines, from the update of their trees to contacts: culling by detector points (Yeh 2012, chapter 4), and ICCD as the
 * thesis has it (section 5.1), on the same trees and tests. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

extern const own_search detector_based_search, iccd_search;
