/* A context for each level of vector instructions that this processor has. */
#pragma once

#include "cscd/cscd.h"

enum { LEVEL_COUNT = CSCD_SIMD_AVX512 };

/* From SCALAR on; NULL: the processor has it not. */
extern cscd_context *contexts[LEVEL_COUNT];

/* Set-up and tear-down of a suite. */
int open_levels(void **state);
int close_levels(void **state);
