/* A context for each level of vector instructions that this processor has. */
#pragma once

#include "src/core/system.h"

enum { LEVEL_COUNT = SIMD_LAST };

/* There is one context per level, from SCALAR on; NULL when the processor lacks the level. */
extern cscd_context *contexts[LEVEL_COUNT];

/* The set-up and tear-down of a test program. */
int open_levels(void **state);
int close_levels(void **state);
