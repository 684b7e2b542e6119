/* What the contacts found so far say about triangles: those in contact with their component are tainted. */
#pragma once

#include "runtime/detector/detector.h"

/* An interval begins: no component is touched. Before the first contact. */
void tainting_begin(cscd_detector *detector);

/* Looks at the contacts that the lanes have gained since the last look, ignored pairs among them. Of those of
 * a component with itself the stars of both features are tainted; in components that are finished, these lose
 * their orientations. Returns how many did. */
uint32_t tainting_look(cscd_detector *detector);
