/* The frames of a motion that a plan is made for. */
#pragma once

#include "preprocess/regions/tiles.h"
#include "src/mesh/plan.h"

typedef struct plan_frames {
    uint32_t count;
    const double *items[FRAMES_MOST]; /* packed positions */
    double *buffers[FRAMES_MOST];     /* those that had to be copied */
} plan_frames;

/* Reads and checks the frames of the options, or FRAMES_MOST of them, evenly spaced. Free them also after a failure. */
cscd_status plan_frames_read(cscd_context *context, const cscd_mesh *mesh, const cscd_plan_options *options,
                             plan_frames *out);
void plan_frames_free(cscd_context *context, plan_frames *frames);
