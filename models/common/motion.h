/* How soft and how fast a recording is, and where it runs into itself. */
#pragma once

#include "cscd/cscd.h"

/* What has been measured so far. Residuals are root mean squares over the vertices of what is left after the
 * best rigid motion from the first frame, as shares of the first frame's diagonal. */
typedef struct recording_motion {
    const cscd_mesh *mesh;
    cscd_detector *detector;
    double *first, *last;
    double diagonal, edge_length; /* of the first frame; the mean */
    uint32_t frame_count;
    uint32_t soft_frames;       /* residual above 3 % */
    uint32_t crossing_frames;   /* the mesh crosses itself there */
    uint32_t contact_intervals; /* from frame to frame */
    double largest_residual;
    double largest_motion; /* of a vertex from frame to frame, in edge lengths */
} recording_motion;

/* At the first frame. On another status than CSCD_OK there is nothing to free. */
cscd_status recording_motion_begin(const cscd_mesh *mesh, const double *first, recording_motion *out);
cscd_status recording_motion_add(recording_motion *m, const double *frame);
void recording_motion_free(recording_motion *m);

/* Root mean square of what the best rigid motion leaves between two sets of points (Horn, "Closed-form
 * solution of absolute orientation using unit quaternions", 1987). */
double rigid_residual(const double *from, const double *to, uint32_t point_count);
