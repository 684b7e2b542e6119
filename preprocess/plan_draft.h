/* What the steps of preprocessing find, before it becomes a plan. */
#pragma once

#include "preprocess/charges.h"
#include "preprocess/plan_frames.h"

typedef struct plan_draft {
    const cscd_mesh *mesh;
    const double *positions; /* at rest */
    const plan_frames *frames;
    cscd_plan_options options; /* of a method other than AUTO */
    uint32_t *regions;         /* of each triangle */
    uint32_t region_count;
    double *detector_points;        /* 3 * region_count */
    double *charges, *capacitances; /* NULL without charge */
    cscd_preprocess_timings timings;
    charge_kernels kernels;
} plan_draft;

/* Takes the steps of the method: charge, regions, detector points. Free it also after a failure. */
cscd_status plan_draft_make(const cscd_mesh *mesh, const double *positions, const plan_frames *frames,
                            const cscd_plan_options *options, plan_draft *out);
void plan_draft_free(plan_draft *d);

/* How the charge is solved for, where the method needs it. */
cscd_charge_solver plan_draft_solver(const plan_draft *d);
