/* The outer surfaces of bodies, what bodies do not bury in themselves, and the points of these surfaces that are near to others. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "runtime/intersections/intersections.h"

/* A convex part of a triangle, scaled. */
typedef struct outer_part {
    double corners[3][3];
} outer_part;

/* Has all parts of a triangle; scaled. */
typedef struct outer_box {
    double low[3], high[3];
} outer_box;

/* So many parts that follow each other have a box together: a triangle that is cut by hundreds has thousands of parts. */
enum { OUTER_RUN = 16 };

#define OUTER_AS_A_WHOLE UINT32_MAX
#define OUTER_NOWHERE    (UINT32_MAX - 1)

/* The memory of all calls; begins with the context, also of cuts, and nothing else set. The triangles that their own body
 * cuts have parts; all others are outer as a whole, or not at all. */
typedef struct outer_surface {
    cscd_context *context;
    double scale; /* the scale of the trees, which multiplies parts and distances */
    triangle_cuts cuts;
    outer_part *parts;
    outer_box *part_boxes;
    size_t part_count, part_capacity;
    outer_box *run_boxes; /* run k has the parts from OUTER_RUN * k on, of whatever triangle */
    size_t run_capacity;
    uint32_t *cut_triangles; /* ascending: those with parts, or none of them outer */
    size_t *part_begins;     /* per cut triangle and one more: where its parts begin */
    outer_box *boxes;        /* per cut triangle: of its parts; without parts low is above high */
    size_t cut_count, cut_capacity;
    uint32_t *places; /* per triangle: its place among those with parts, OUTER_AS_A_WHOLE or OUTER_NOWHERE */
    size_t place_capacity;
    memory_budget *budget; /* of the call, for parts; NULL: there is no limit */
} outer_surface;

void outer_surface_free(outer_surface *o);

/* Finds the parts. False: no memory. */
bool outer_surface_find(outer_surface *o, const surface_cuts *found, const bvh *hierarchy);

/* Takes the work of comparing this number of points with the parts that are near them, of which a triangle
 * that is cut has the mean number. False: it does not fit. */
bool outer_surface_take_work(const outer_surface *o, size_t points);

/* A triangle that is outer as a whole. */
void outer_surface_whole(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                         outer_part *out);

/* ---- near points --------------------------------------------------------------------------------------- */

/* The nearest point of a body's outer surface. */
typedef struct outer_point {
    double squared;    /* the squared distance, scaled; INFINITY: the body has no outer surface */
    uint32_t triangle; /* which has the point */
    outer_part part;   /* the same, or the part of it */
    double x[3];
} outer_point;

/* Returns the scaled distance of a point from some point of a part: up to rounding, the nearest one. */
double outer_part_reach(const outer_surface *o, const double x[3], const outer_part *part);

/* The greatest for three points; or, as soon as it is no less than enough, that of some of them. */
double outer_part_reach_of_all(const outer_surface *o, const double *const x[3], const outer_part *part,
                               double enough);

/* near: the answer for another point and the same body, or NULL. The nearer the points, the shorter the search; the
 * answer does not depend on it. */
outer_point outer_surface_nearest(const outer_surface *o, const surface_cuts *found, const bvh *hierarchy,
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
outer_point outer_surface_search(const outer_surface *o, const surface_cuts *found, const bvh *hierarchy,
                                 uint32_t body, const double x[3], const outer_point *near, double enough);

/* Whether the point lies on a triangle of the body's closed components, exactly. The bounds of the trees are those of the surface's
 * positions. */
bool body_has_point(const named_surface *s, const bvh *hierarchy, uint32_t body, const double x[3]);
