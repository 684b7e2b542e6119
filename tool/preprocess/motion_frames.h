/* Frames of a recording for which a plan is made. */
#pragma once

#include "tool/common/frame_range.h"
#include "tool/common/recording.h"

/* As many as a plan looks at. */
enum { MOTION_FRAMES_MOST = 8 };

typedef struct motion_frames {
    uint32_t count;
    double *positions;
    cscd_view views[MOTION_FRAMES_MOST];
    const cscd_view *items[MOTION_FRAMES_MOST]; /* as cscd_plan_options takes them */
} motion_frames;

/* Reads frames of the range, evenly spaced, the first and the last among them. On false there is nothing to free. */
bool motion_frames_read(recording *r, const frame_range *range, motion_frames *out, io_error *error);
void motion_frames_free(motion_frames *frames);
