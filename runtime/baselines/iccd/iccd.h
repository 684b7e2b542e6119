/* ICCD (Tang et al. 2009) as a stage of a step: it hides the pairs within patches that cannot touch themselves. */
#pragma once

#include "runtime/culling/culling_rules.h"

extern const pair_hider
    iccd_hider; /* corrected: no contact is lost, whatever the start (docs/theory/iccd.md) */
extern const pair_hider iccd_published_hider;

/* As published, any set of triangles is a patch, and adjacent triangles never touch. */
extern const culling_rules iccd_published_culling;
