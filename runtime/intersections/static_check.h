/* Finds all pairs of triangles that intersect at one moment, by exact predicates. */
#pragma once

#include "runtime/bvh/traversal.h"
#include "runtime/intersections/intersection_lane.h"
#include "runtime/intersections/vertex_stars.h"

/* The outcome of the last check, and the memory of all checks. */
typedef struct static_check {
    const cscd_mesh *mesh;
    bool *unproven; /* per triangle: is it compared with the others? */
    bool *crossing; /* per unproven triangle: it intersects another one of its component, or has no area */
    intersection_lane
        *lanes; /* one per lane of the traversal; their pairs include those that the caller ignores */
    uint32_t lane_count;
    vertex_stars stars;
    bool kinds; /* the check asks for them: lanes have notes, and duplicates */

    /* With a limit, lanes that have so many pairs beside settled ones are asked to be emptied, on the calling thread, after the triangles of
     * these pairs have been marked as crossing. SIZE_MAX: none has a limit. */
    size_t limit;
    void (*spill)(void *data); /* NULL: the pairs are dropped */
    void *spill_data;

    /* The rules for objects, and the object of each component. They are read where trees mix objects; elsewhere the
     * traversal has left out what they say. NULL: there are none. */
    const object_set *objects;
    const uint32_t *component_objects;

    /* The components without a surface at the moment, whose triangles intersect nothing, set by the caller together with
     * those of the traversal. NULL: all are compared. */
    const bool *collapsed;
} static_check;

/* On failure *out holds nothing. */
cscd_status static_check_create(const cscd_mesh *mesh, uint32_t lane_count, static_check *out);
void static_check_destroy(static_check *c);

/* Compares the triangles that are marked as unproven with one another, each with those of its own component. The
 * volumes of the trees must contain the triangles at positions, so they belong to that moment or to an interval that
 * contains it. CANCELLED, here and below: not all pairs have been compared. */
cscd_status static_check_unproven(static_check *c, traversal *t, bvh *f, const double *positions);

/* Compares all triangles whose objects are looked at with one another, and marks all triangles as unproven. */
cscd_status static_check_all(static_check *c, traversal *t, bvh *f, const double *positions);

/* The same, with the kind of each pair, and with duplicates, which mark nothing. names: see pair_kind.h. */
cscd_status static_check_kinds(static_check *c, traversal *t, bvh *f, const double *positions,
                               const uint32_t *names);

/* ---- in pieces, for other searches --------------------------------------------------------------------- */

/* Data that the threads of a check share. */
typedef struct check_work {
    static_check *check;
    traversal *traversal;
    const bvh *bvh;
    const double *positions;
    bool own_component_only; /* pairs of triangles of two components do not count */
    bool by_stars;           /* pairs that share a vertex come from the stars, and not from the traversal */
    const uint32_t *names;   /* where kinds are asked for; NULL: each vertex has its own */
} check_work;

/* Empties the lanes, and looks for triangles without area. */
void static_check_begin(check_work *work);

/* Adds the pairs of a batch that intersect to the lane of the same number. */
void static_check_test_batch(const check_work *work, uint32_t lane);
