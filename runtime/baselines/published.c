/* The culling rules of the thesis as published, which lose contacts (docs/theory/culling.md). */
#include "runtime/baselines/published.h"

const culling_rules published_culling = {.by_orientation = true,
                                         .assumes_clean = true,
                                         .embedded_only = true,
                                         .still_points = true,
                                         .fixed_representatives = true,
                                         .skips_adjacent = true};

culling_rules published_rules(int set) {
    culling_rules rules = {.by_orientation = true, .embedded_only = true};
    rules.assumes_clean = (set & PUBLISHED_UNPROVEN) != 0;
    rules.still_points = (set & PUBLISHED_STILL) != 0;
    rules.fixed_representatives = (set & PUBLISHED_REPRESENTATIVES) != 0;
    rules.skips_adjacent = (set & PUBLISHED_ADJACENT) != 0;
    return rules;
}
