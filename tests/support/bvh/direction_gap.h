/* Gaps between moving features along the seven directions of 14-DOPs, in long double. */
#pragma once

#include <stdint.h>

enum { DIRECTION_COUNT = 7 };

/* The directions are x, y, z, x+y+z, x+y-z, x-y+z, -x+y+z. */
extern const int directions[DIRECTION_COUNT][3];

/* The vertices of a point, an edge or a face. */
typedef struct point_set {
    const uint32_t *vertices;
    int count;
} point_set;

/* Positions, three per vertex, at both ends of an interval. */
typedef struct gap_motion {
    const double *x0, *x1;
} gap_motion;

long double along_direction(const long double p[3], int direction);

/* Returns a length: the largest, over all directions and their opposites, of the smaller of the gaps at
 * both ends. When it is positive, all points of a and b stay farther apart than that throughout. The
 * search ends early with any length above `enough`. */
long double direction_gap(gap_motion m, point_set a, point_set b, long double enough);

/* Returns the same length for x, y and z alone. */
long double axis_gap(gap_motion m, point_set a, point_set b, long double enough);

/* Returns the largest magnitude of a coordinate relative to that of vertex 0 at the start. */
double motion_extent(gap_motion m, uint32_t vertex_count);
