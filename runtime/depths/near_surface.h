/* The nearest point of an outer surface, and points that are near, which are found faster. */
#pragma once

#include "runtime/depths/outer_surface.h"

/* The nearest point of a body's outer surface. */
typedef struct outer_point {
    double squared;    /* the squared distance, scaled; INFINITY: the body has no outer surface */
    uint32_t triangle; /* which has the point */
    outer_part part;   /* the same, or the part of it */
    double x[3];
} outer_point;

/* The scaled distance of a point from some point of a part: the nearest one, but for rounding. */
double outer_part_reach(const outer_surface *o, const double x[3], const outer_part *part);

/* The greatest for three points; or, as soon as it is no less than enough, that of some of them. */
double outer_part_reach_of_all(const outer_surface *o, const double *const x[3], const outer_part *part,
                               double enough);

/* near: the answer for another point and the same body, or NULL. The nearer the points, the shorter the search; the
 * answer does not depend on it. */
outer_point outer_surface_nearest(const outer_surface *o, const surface_cuts *found, const bvh *f,
                                  uint32_t body, const double x[3], const outer_point *near);

/* Some point that is near to x, on a triangle or on those that one comes to from it over sides, going nearer until it is no farther
 * than enough: no search is needed. Its distance is no less than that of the nearest one; its own x is not set. */
outer_point outer_surface_near(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                               const double x[3], double enough);

/* The same on one triangle. */
outer_point outer_surface_near_on(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                                  const double x[3]);

/* The nearest point, which is looked for from a near one on. near: the answer for another point and the same body, or NULL.
 * enough: if such a near point is no farther than this, scaled, it is the answer. */
outer_point outer_surface_search(const outer_surface *o, const surface_cuts *found, const bvh *f,
                                 uint32_t body, const double x[3], const outer_point *near, double enough);
