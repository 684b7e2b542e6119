/* What is left out, changed on a live detector: by rules for objects, seams and ignored pairs. */
#pragma once

#include "runtime/detector/detector.h"

/* Gives a new detector its rules. INVALID_ARGUMENT names what does not fit; then it has none. */
cscd_status detector_set_rules(cscd_detector *d, const given_rules *given);

/* Takes rules over that were made for the detector's mesh, as the last step of the above. */
void detector_take_rules(cscd_detector *d, const pair_rules *rules);
