/* The culling rules of the thesis as published, which lose contacts (docs/theory/culling.md). */
#pragma once

#include "runtime/culling/culling_rules.h"

/* The differences between the published rules and ours; a benchmark switches single ones on. */
enum {
    PUBLISHED_UNPROVEN = 1,        /* culls also where the start is not known to be embedded */
    PUBLISHED_STILL = 2,           /* the detector point stays where it is at the start */
    PUBLISHED_REPRESENTATIVES = 4, /* the first triangle at a feature tests it, whatever the orientations */
    PUBLISHED_ADJACENT = 8,        /* triangles that share a vertex are not tested */
    PUBLISHED_ALL = 15
};

/* Returns the rules for a set of these. Without PUBLISHED_UNPROVEN only embedded components are culled. */
culling_rules published_rules(int set);

extern const culling_rules published_culling; /* the rules of PUBLISHED_ALL */
