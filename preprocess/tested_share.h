/* Predicts how much work a plan leaves to a step. */
#pragma once

#include "preprocess/plan_draft.h"

/* The share of the triangles, but for obstacles, that a step has to look at with others of their component: those of components that
 * are not closed, which are not culled; those at the border of their region; and those that its detector point does not see, with
 * those that it hardly sees in part (sight.h). At rest and in all frames, in the mean; and what lies beyond soft material counts as
 * hardly seen (soft_ways.h). */
cscd_status find_tested_share(const plan_draft *d, double *out);
