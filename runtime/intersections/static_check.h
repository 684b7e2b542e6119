/* Finds all pairs of triangles that intersect at one moment, by exact predicates. */
#pragma once

#include "runtime/bvh/traversal.h"

/* The findings of one thread. */
typedef struct intersection_lane {
    _Alignas(CACHE_LINE_SIZE) cscd_intersection *items;
    size_t count, capacity;
    size_t settled; /* so many of the first ones are there to stay: they do not count for the limit */
    uint32_t zero_area_triangles, first_zero_area; /* UINT32_MAX: none */
    bool out_of_memory;
} intersection_lane;

/* The outcome of the last check, and the memory of all checks. */
typedef struct static_check {
    const cscd_mesh *mesh;
    bool *unproven; /* per triangle: is it compared with the others? */
    bool *crossing; /* per unproven triangle: it intersects another one of its component, or has no area */
    intersection_lane
        *lanes; /* one per lane of the traversal; their pairs include those that the caller ignores */
    uint32_t lane_count;

    /* With a limit, lanes that have so many pairs beside settled ones are asked to be emptied, on the calling thread, after the triangles of
     * these pairs have been marked as crossing. SIZE_MAX: none has a limit. */
    size_t limit;
    void (*spill)(void *data); /* NULL: the pairs are dropped */
    void *spill_data;

    /* The rules for objects, and the object of each component. They are read where trees mix objects; elsewhere the
     * traversal has left out what they say. NULL: there are none. */
    const object_set *objects;
    const uint32_t *component_objects;
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
