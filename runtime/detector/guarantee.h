/* What a step promises for the contacts of a component with itself. */
#pragma once

#include "runtime/detector/detector.h"

/* Of the current interval, all of whose stages are done. */
cscd_guarantee guarantee_of(const cscd_detector *d, uint32_t component);
