/* Makes drafts by several methods, and keeps the one that leaves the least to test. */
#pragma once

#include "preprocess/plan_draft.h"

/* Makes drafts by charge, by K-means with several numbers of regions and by single ones. options: of method AUTO. Where the charge
 * fails the others are compared, and the list says why. Free the draft also after a failure. */
cscd_status best_draft_make(const cscd_mesh *mesh, const double *positions, const plan_frames *frames,
                            const cscd_plan_options *options, plan_candidates *candidates, plan_draft *out);
