/* The methods that this build has: without runtime/baselines there are no CONES, ICCD, ICCD_PUBLISHED and PUBLISHED. */
#pragma once

#include "cscd/cscd.h"

/* Returns the method itself, or NONE in a build without baselines when it is one of them. Fails the test
 * if a build lacks a method that it should have, or has one that it should lack, or refuses one without
 * the sentence that says why. */
cscd_method method_or_none(cscd_method method);

/* The options.ours with which a method needs no library beside libcscd: the published ones, with elementary tests of ours. */
uint64_t ours_of_method(cscd_method method);
