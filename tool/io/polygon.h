/* Cuts a face of a mesh file into triangles by its shape. */
#pragma once

#include <stddef.h>
#include <stdint.h>

typedef enum polygon_result {
    POLYGON_FILLED, /* by triangles that do not overlap in the plane of two coordinates */
    POLYGON_FANNED, /* by a fan around the first corner: the polygon is simple in no such plane, or has no area there */
    POLYGON_OUT_OF_MEMORY
} polygon_result;

/* Cuts a polygon of corner_count corners, at least 3, into corner_count - 2 triangles of its vertices, with its
 * orientation. positions: of all vertices, three doubles each. The polygon is looked at in the plane of two coordinates that
 * shows most of its area, so coordinates stay exact, and all decisions are exact. A triangle stays as it is; a polygon
 * that is convex without corners on a line, and has at most 128, becomes a fan around its first corner; a quad gets the diagonal that lies
 * inside. Holes may be bridged: the corners go to the hole and come back on the same way. A polygon that crosses itself
 * becomes a fan; of more than 128 corners it may also be filled, by triangles that lie twofold in places. */
polygon_result polygon_fill(const double *positions, const uint32_t *corners, uint32_t corner_count,
                            uint32_t (*triangles)[3]);
