/* Polygons with whole coordinates, and an oracle of how they are filled: area, orientation, edges and winding. */
#pragma once

#include "tests/support/random.h"

#include <stdbool.h>
#include <stdint.h>

enum { FLAT_CORNERS_MAX = 96 };

/* Counter-clockwise; a vertex may be named twice where the polygon goes to a hole and back. */
typedef struct flat_polygon {
    int64_t points[FLAT_CORNERS_MAX][2]; /* of vertices */
    uint32_t vertex_count;
    uint32_t corners[FLAT_CORNERS_MAX];
    uint32_t corner_count;
} flat_polygon;

/* Adds a vertex, and a corner that names it. */
void flat_polygon_add(flat_polygon *p, int64_t x, int64_t y);

int64_t flat_polygon_area(const flat_polygon *p); /* twice the area */

/* How often the polygon winds around a point that lies on none of its edges. */
int flat_polygon_winding(const flat_polygon *p, const int64_t z[2]);

/* Simple: edges meet at corners that they share only, and neighbours do not fold back. */
bool flat_polygon_is_simple(const flat_polygon *p);

/* Puts the polygon into space, in one of the planes of two coordinates, begun at one of its corners, one way around or the
 * other, all by chance, and asserts that polygon_fill fills it. */
void flat_polygon_check(const flat_polygon *p, random_stream *random);

/* Twice the area of a triangle: positive if a, b, c turn left. */
int64_t flat_cross(const int64_t a[2], const int64_t b[2], const int64_t c[2]);

bool flat_points_equal(const int64_t a[2], const int64_t b[2]);

/* Whether two closed segments have a point in common. */
bool flat_segments_meet(const int64_t a[2], const int64_t b[2], const int64_t c[2], const int64_t d[2]);
