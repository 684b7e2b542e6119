/* Changes the motion that a solver wants into one near it that is certified to have no contact. */
#pragma once

#include "cscd/cscd.h"

/* Totals since the start. */
typedef struct safe_motion_counts {
    uint64_t steps;            /* calls of cscd_detector_step */
    uint64_t contacts;         /* found by these calls */
    uint64_t cut;              /* motions that needed a change */
    uint64_t fallbacks, waits; /* motions that took cscd_detector_max_step; motions without any way on */
    uint64_t tight;            /* motions that began too near for the first separation to leave them a way */
    uint32_t tightest;         /* the smallest separation that was needed; 0 is the first */
} safe_motion_counts;

/* Each separation is a quarter of the one before. */
enum { SAFE_MOTION_SEPARATIONS = 5 };

/* Limits how far the points of a contact may approach along its normal. */
typedef struct safe_motion_stop {
    cscd_stencil stencil;
    double normal[3], allowed;
} safe_motion_stop;

/* A set of vertices that move together; its smallest vertex names it. */
typedef struct safe_motion_zone {
    double motion[3], mass;  /* sums of mass times motion, and of mass */
    double told[3], tellers; /* sum and number of the motions of obstacles in contact with it */
    double share;            /* the share that this round leaves of motions that differ */
} safe_motion_zone;

/* The caller owns mesh, seams and inverse_masses, which has one number per vertex, 0 for vertices with
 * given motions. */
typedef struct safe_motion {
    cscd_detector *detector; /* its separation is that of the last motion */
    const cscd_mesh *mesh;
    double separation; /* the first */
    uint32_t which;    /* of the separations is that of the detector */
    const double *inverse_masses;
    const uint32_t *seams; /* pairs of vertices that move as one */
    uint32_t seam_count;
    uint32_t vertex_count;
    safe_motion_stop *stops; /* of the current motion */
    size_t stop_count, stop_capacity;
    uint32_t *parents;       /* zones of the current motion, as a forest of vertices */
    safe_motion_zone *zones; /* indexed by the vertices that name them */
    double (*told)[4];       /* per vertex: sum and number of the motions of obstacles in contact */
    double *reached;         /* the end of a motion that is shortened as a whole */
    safe_motion_counts counts;
} safe_motion;

cscd_status safe_motion_open(const cscd_mesh *mesh, double separation, const double *inverse_masses,
                             const uint32_t *seams, uint32_t seam_count, safe_motion *out);
void safe_motion_close(safe_motion *s);

/* Changes x1 until the straight motion from x0 to x1 has no contact: features stay farther apart than the
 * separation or, where they were pressed together and begin nearer than that, than the next one, and so
 * on. x0 has no contact. *length is 1, or the share of their way that the obstacles went, down to 0: when
 * no other motion is left, all vertices stop on the way, and the obstacles with them. Vertices that are
 * sewn together have equal positions in x0 and in x1. */
cscd_status safe_motion_find(safe_motion *s, const double *x0, double *x1, double *length);

/* Moves both vertices of each seam to their common centre of mass. */
void safe_motion_sew(const safe_motion *s, double *positions);
