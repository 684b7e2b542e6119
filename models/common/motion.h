/* Measurements of a recording: its softness, its speed, and its contacts with itself. */
#pragma once

#include "cscd/cscd.h"

/* Measurements so far. A residual is the root mean square distance of the vertices that remains after the
 * best rigid motion from the first frame, as a share of the first frame's diagonal. */
typedef struct recording_motion {
    const cscd_mesh *mesh;
    cscd_detector *detector;
    double *first, *last;
    double diagonal, edge_length; /* diagonal and mean edge length of the first frame */
    uint32_t frame_count;
    uint32_t soft_frames;         /* with a residual above 3 % */
    uint32_t intersecting_frames; /* with intersections */
    uint32_t contact_intervals;   /* with contacts */
    double largest_residual;
    double largest_motion; /* of a vertex from frame to frame, in edge lengths */
} recording_motion;

/* Begins with the first frame. When the status is not CSCD_OK, there is nothing to free. */
cscd_status recording_motion_begin(const cscd_mesh *mesh, const double *first, recording_motion *out);
cscd_status recording_motion_add(recording_motion *m, const double *frame);
void recording_motion_free(recording_motion *m);

/* Returns the root mean square distance that remains between two sets of points after the best rigid
 * motion (Horn, "Closed-form solution of absolute orientation using unit quaternions", 1987). */
double rigid_residual(const double *from, const double *to, uint32_t point_count);
