/* Changes the motion that a solver wants into one that displacement bounds or planes allow, without a test on the way. */
#pragma once

#include "cscd/cscd.h"

/* What keeps the motion of a frame free of contact. */
typedef enum motion_driver {
    DRIVER_STEPS,  /* safe_motion: continuous detection */
    DRIVER_BOUNDS, /* a ball for each vertex, as in Offset Geometric Contact (Chen et al. 2025) */
    DRIVER_PLANES, /* planes between near pairs, as in Divide and Truncate (Chen et al. 2026) */
    DRIVER_COUNT
} motion_driver;

/* "steps", "bounds" and "planes". */
const char *motion_driver_name(motion_driver driver);

/* The caller owns detector and mesh. */
typedef struct bounded_motion {
    cscd_detector *detector;
    const cscd_mesh *mesh;
    motion_driver driver;              /* not DRIVER_STEPS */
    double shortest_reach;             /* of the search for near pairs; the longest is twice that */
    uint32_t free_count, vertex_count; /* vertices that are not of obstacles come first */
    double *now, *wanted, *reached, *bounds;
    uint32_t most_rounds; /* of one motion: 8 */
    double left_over;     /* total: distances that the first rounds have left, obstacles aside */
    uint64_t rounds;      /* total: searches for near pairs */
} bounded_motion;

void bounded_motion_open(cscd_detector *detector, const cscd_mesh *mesh, motion_driver driver,
                         double shortest_reach, uint32_t free_count, bounded_motion *out);
void bounded_motion_close(bounded_motion *b);

/* Changes x1 to where the vertices come from x0 on the way to it, round by round. There is no contact on the straight
 * lines from round to round, and features that begin farther apart than the detector's min_separation stay so.
 * *length is the share of their way that the obstacles went. */
cscd_status bounded_motion_find(bounded_motion *b, const double *x0, double *x1, double *length);
