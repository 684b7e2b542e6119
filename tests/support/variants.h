/* The variants that tests go through: the methods of this build, and the instruction sets of this processor. */
#pragma once

#include "cscd/cscd.h"
#include "src/core/system.h"

/* Returns the method itself, or NONE in a build without baselines when it is one of them. Fails the test
 * if a build lacks a method that it should have, or has one that it should lack, or refuses one without
 * the sentence that says why. */
cscd_method method_or_none(cscd_method method);

/* The options.ours with which a method needs no library beside libcscd: the published ones, with elementary tests of ours. */
uint64_t ours_of_method(cscd_method method);

/* ---- instruction sets ---------------------------------------------------------------------------------- */

enum { LEVEL_COUNT = SIMD_LAST };

/* There is one context per level, from SCALAR on; NULL when the processor lacks the level. */
extern cscd_context *contexts[LEVEL_COUNT];

/* The set-up and tear-down of a test program. */
int open_levels(void **state);
int close_levels(void **state);
