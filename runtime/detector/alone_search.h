/* An interval that a method searches by itself, with trees and tests of its own, in place of those of a step. */
#pragma once

#include "runtime/detector/detector.h"

/* Leaves contacts in the lanes. all_clean: every triangle of the components that are culled is clean. CANCELLED: not all pairs are
 * tested. */
cscd_status search_interval_alone(cscd_detector *d, interval_search *search, bool all_clean);
