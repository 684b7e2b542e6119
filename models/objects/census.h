/* Finds which objects of a recording touch each other, and when, by detector steps from frame to frame. */
#pragma once

#include "cscd/cscd.h"

/* Counts so far. Objects are the components of the mesh. */
typedef struct census {
    const cscd_mesh *mesh;
    cscd_detector *detector;
    double *last;       /* the last frame */
    double edge_length; /* the mean in the first frame */
    uint32_t frame_count, object_count;
    uint32_t between_intervals;   /* with contacts between objects */
    uint32_t within_intervals;    /* with contacts within an object */
    uint32_t intersecting_frames; /* with intersections */
    uint64_t contacts;            /* between and within objects */
    double largest_motion;        /* of a vertex from frame to frame, in edge lengths */
    bool *pairs;                  /* object_count^2: those that have touched; on the diagonal, themselves */
    bool touching;                /* whether objects touched each other in the last interval */
} census;

/* Begins without a frame. When the status is not CSCD_OK, there is nothing to free. */
cscd_status census_begin(const cscd_mesh *mesh, census *out);
cscd_status census_add(census *c, const double *frame);
void census_free(census *c);

/* Returns the number of pairs of different objects that have touched. */
uint32_t census_pair_count(const census *c);
