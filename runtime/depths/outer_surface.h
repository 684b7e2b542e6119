/* The outer surfaces of bodies: what they do not bury in themselves. */
#pragma once

#include "runtime/bvh/bvh_query.h"
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
    double scale; /* that of the trees: parts and distances are so many times as large */
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
bool outer_surface_find(outer_surface *o, const surface_cuts *found, const bvh *f);

/* Takes the work of comparing so many points with the parts that are near them, of which a triangle that is cut has as many as all of
 * them have in the mean. False: it does not fit. */
bool outer_surface_take_work(const outer_surface *o, size_t points);

/* A triangle that is outer as a whole. */
void outer_surface_whole(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                         outer_part *out);
