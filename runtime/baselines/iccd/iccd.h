/* ICCD (Tang et al. 2009) as a stage of a step: it hides the pairs within patches that cannot touch themselves. */
#pragma once

#include "runtime/culling/culling_rules.h"

/* Corrected: no contact is lost, whatever the start (docs/theory/iccd.md). */
extern const pair_hider iccd_hider;
