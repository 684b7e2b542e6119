/* The star test: does the projection of a patch's contour, with ears where it turns inwards, stay star-shaped around its middle? */
#pragma once

#include "runtime/baselines/iccd/contour.h"

/* A vertex of a contour, projected, at both ends of the interval. */
typedef struct star_vertex {
    double at[2][2]; /* [time][axis], from the middle */
    uint32_t kept;   /* of the i-th vertex: which one is the i-th that no ear has cut off */
} star_vertex;

/* Certified for the loop of a disk whose triangles all face the axis: true only if the projection of the disk is one-to-one at every
 * moment of the interval (docs/theory/cones.md). Linear in the loop's length. vertices: room for edge_count of them. */
bool contour_stays_star(const contour_query *query, star_vertex *vertices);

/* contour_stays_star as a test of patches. */
extern const contour_test star_test;
