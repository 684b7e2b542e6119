/* Finds the vector instructions of the processor. */
#pragma once

#include "cscd/cscd.h"

/* Levels are the values from CSCD_SIMD_SCALAR to this one. */
#define SIMD_LAST CSCD_SIMD_NEON

/* The best level that this processor, its operating system and this build have; never AUTO. */
cscd_simd processor_best_simd(void);

/* Whether they have this level; false for AUTO and for what is no level. */
bool processor_has_simd(cscd_simd simd);
