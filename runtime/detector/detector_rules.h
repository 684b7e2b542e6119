/* What is left out, changed on a live detector: by rules for objects, seams and ignored pairs. */
#pragma once

#include "runtime/detector/detector.h"

/* Gives a new detector its rules. INVALID_ARGUMENT names what does not fit; then it has none. */
cscd_status detector_set_rules(cscd_detector *d, const given_rules *given);
