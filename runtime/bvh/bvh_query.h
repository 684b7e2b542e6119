/* Triangles near a point or a box at one moment, by the trees. The bounds are those of the last bvh_refit, which was to
 * that moment. */
#pragma once

#include "runtime/bvh/bvh.h"

/* A box; a high of infinity is allowed. */
typedef struct query_box {
    double low[3], high[3];
} query_box;

/* A box in the frame of a tree, rounded outward. */
typedef struct framed_query {
    float low[3], high[3];
} framed_query;

/* Calls visit for each triangle whose bounding volume overlaps the box, and perhaps for some more. closed_only:
 * those of components that are no closed manifolds may be left out. */
void bvh_visit_box(const bvh *hierarchy, const query_box *box, bool closed_only,
                   void (*visit)(void *data, uint32_t triangle), void *data);

/* The triangles that are asked for: those of an object, in components with this number. */
typedef struct near_quest {
    uint32_t object, number;
    const uint32_t *numbers; /* per component; NULL: all components */
} near_quest;

/* Calls visit for each triangle that is asked for, and perhaps for some others, whose bounding volume may be as near to
 * the point as the root of *squared, nearer blocks first; visit may lower *squared, which is a squared distance times
 * the square of the trees' scale, so that it neither overflows nor vanishes. INFINITY: any distance. */
void bvh_visit_near(const bvh *hierarchy, const near_quest *quest, const double point[3], double *squared,
                    void (*visit)(void *data, uint32_t triangle), void *data);
