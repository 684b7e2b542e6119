/* Which objects of a recording touch each other, and when: by the detector, from frame to frame. */
#pragma once

#include "cscd/cscd.h"

/* Objects are the mesh's components. What has been counted so far. */
typedef struct census {
    const cscd_mesh *mesh;
    cscd_detector *detector;
    double *last;       /* the last frame */
    double edge_length; /* the mean in the first frame */
    uint32_t frame_count, object_count;
    uint32_t between_intervals; /* with contacts between objects, from frame to frame */
    uint32_t within_intervals;  /* with contacts within an object */
    uint32_t crossing_frames;   /* something crosses there */
    uint64_t contacts;          /* of both kinds */
    double largest_motion;      /* of a vertex from frame to frame, in edge lengths */
    bool *pairs;                /* object_count^2: those that have touched; on the diagonal, themselves */
    bool touching;              /* objects touch each other in the last interval */
} census;

/* Without a frame. On another status than CSCD_OK there is nothing to free. */
cscd_status census_begin(const cscd_mesh *mesh, census *out);
cscd_status census_add(census *c, const double *frame);
void census_free(census *c);

/* Pairs of different objects that have touched. */
uint32_t census_pair_count(const census *c);
