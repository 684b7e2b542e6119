/* How deep the points of whole triangles may be: docs/theory/curves.md, Lemma 9. */
#pragma once

#include "runtime/intersections/depths.h"

/* The memory of all calls; begins with the context and nothing else set. */
typedef struct depth_bounder {
    cscd_context *context;
    uint64_t *keys, *spare_keys;
    size_t key_capacity;
    cscd_triangle_depth *items;
    size_t item_capacity;
} depth_bounder;

void depth_bounder_free(depth_bounder *b);

/* Bounds the depths of all triangles by those of their vertices, and adds the list to *depths, where it lives until the next
 * call. OUT_OF_MEMORY and CANCELLED have no sentence. */
cscd_status depth_bounder_run(depth_bounder *b, const surface_cuts *found, cscd_depths *depths);

/* The greatest over the points of a triangle of the least over its corners of depths[i] + the distance from the corner:
 * never less, and more by at most some 1e-6 of the longest side. */
double triangle_depth_bound(const double *const corners[3], const double depths[3]);
