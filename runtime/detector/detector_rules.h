/* The rules for objects on a live detector: who is looked at with whom, and how far apart they have to stay. */
#pragma once

#include "runtime/detector/detector.h"

/* Replaces the rules. INVALID_ARGUMENT names what does not fit; then the detector has the rules of before. */
cscd_status detector_set_rules(cscd_detector *d, const given_rules *given);
