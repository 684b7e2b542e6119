/* A validator of detectors, for debug builds and tests. */
#pragma once

#include "runtime/detector/detector.h"

/* Returns the first fault of a detector as a sentence, or NULL: indices and regions out of range, counts that do not agree,
 * lists out of order, and faults of the trees. Takes linear time; see live_objects_add. */
const char *detector_validate(const cscd_detector *d);
