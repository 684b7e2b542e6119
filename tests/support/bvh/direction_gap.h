/* Gaps between moving features along the seven directions of 14-DOPs, in long double. */
#pragma once

#include <stdint.h>

enum { DIRECTION_COUNT = 7 };

/* x, y, z, x+y+z, x+y-z, x-y+z, -x+y+z */
extern const int directions[DIRECTION_COUNT][3];

/* A point, an edge, a face, by its vertices. */
typedef struct point_set {
    const uint32_t *vertices;
    int count;
} point_set;

/* Positions, three per vertex, at both ends of an interval. */
typedef struct gap_motion {
    const double *x0, *x1;
} gap_motion;

long double along_direction(const long double p[3], int direction);

/* Over all directions and their opposites the largest of the smaller of the gaps at both ends, as a length:
 * where it is positive, all points of a and b stay farther apart than that throughout. Or, where it is more
 * than enough, another that is. */
long double direction_gap(gap_motion m, point_set a, point_set b, long double enough);

/* The same along x, y and z alone. */
long double axis_gap(gap_motion m, point_set a, point_set b, long double enough);

/* The largest magnitude of a coordinate relative to that of the vertex 0 at the start. */
double motion_extent(gap_motion m, uint32_t vertex_count);
