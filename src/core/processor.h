/* Finds the vector instructions of the processor. */
#pragma once

#include "cscd/cscd.h"

/* The best level that this processor, its operating system and this build have; never AUTO. */
cscd_simd processor_best_simd(void);
