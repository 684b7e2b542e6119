/* A motion that meets nothing, certified: from the motion that a solver wants to one near it. */
#pragma once

#include "cscd/cscd.h"

/* What has been done so far. */
typedef struct safe_motion_counts {
    uint64_t steps;            /* calls of cscd_detector_step */
    uint64_t contacts;         /* found by them */
    uint64_t cut;              /* motions that needed a change */
    uint64_t fallbacks, waits; /* that took cscd_detector_max_step; that found no way on, and stayed */
    uint64_t tight;            /* that began too near for the first separation; */
    uint32_t tightest;         /* the last that was needed, 0 the first */
} safe_motion_counts;

/* Each separation is a quarter of the one before. */
enum { SAFE_MOTION_SEPARATIONS = 5 };

/* How near the points of a contact may come to each other along its normal. */
typedef struct safe_motion_stop {
    cscd_stencil stencil;
    double normal[3], allowed;
} safe_motion_stop;

/* Vertices that move together, named by the smallest. */
typedef struct safe_motion_zone {
    double motion[3], mass;  /* summed: mass times motion */
    double told[3], tellers; /* summed: motions of the obstacles that it meets */
    double share;            /* what this round leaves of the motions that differ */
} safe_motion_zone;

/* Owned by the caller: mesh, seams, and inverse_masses, one per vertex, 0 for those that move as they are
 * told. */
typedef struct safe_motion {
    cscd_detector *detector; /* its separation is that of the last motion */
    const cscd_mesh *mesh;
    double separation; /* the first */
    const double *inverse_masses;
    const uint32_t *seams; /* pairs of vertices that move as one */
    uint32_t seam_count;
    uint32_t vertex_count;
    safe_motion_stop *stops; /* of a motion */
    size_t stop_count, stop_capacity;
    uint32_t *parents;       /* the zones of a motion, as a forest of vertices */
    safe_motion_zone *zones; /* at the vertices that name them */
    double (*told)[4];       /* per vertex: sum and number of the motions of obstacles that it met */
    safe_motion_counts counts;
} safe_motion;

cscd_status safe_motion_open(const cscd_mesh *mesh, double separation, const double *inverse_masses,
                             const uint32_t *seams, uint32_t seam_count, safe_motion *out);
void safe_motion_close(safe_motion *s);

/* Changes x1 until vertices that move from x0 to it in straight lines meet nothing on the way: they stay
 * farther apart than the separation, or, where they are pressed together until they begin nearer than that,
 * than the next one, and so on. x0 touches nothing. *length: 1, or how much of their way the obstacles went,
 * down to 0: where no other motion is left, all vertices stop on the way, the obstacles with them. Vertices
 * that are sewn together lie on each other at x0 and x1, and stay so. */
cscd_status safe_motion_find(safe_motion *s, const double *x0, double *x1, double *length);

/* Both vertices of each seam to their common centre of mass. */
void safe_motion_sew(const safe_motion *s, double *positions);
