/* Counts the work of each component with itself, by which the next intervals choose between culling it or not. */
#pragma once

#include "runtime/detector/detector.h"

/* Begins an interval, or a try of one. Its start states have been counted. */
void adaptive_begin(cscd_detector *d);

/* Ends an interval that the vertices go through, before its end becomes the next start. */
void adaptive_learn(cscd_detector *d);
