/* Polygons that move in a plane across any axis, and a reference in long double that looks whether they stay simple. */
#pragma once

#include "tests/support/random.h"

#include <stdbool.h>
#include <stdint.h>

enum { CORNERS_MAX = 40 };

typedef struct polygon {
    uint32_t count;
    double x0[CORNERS_MAX * 3], x1[CORNERS_MAX * 3];
    double frame[3][3]; /* the directions to the right and up, and the axis of projection */
    float axis[3];
} polygon;

/* Chooses any direction; the axis itself has single precision. */
void polygon_choose_axis(polygon *p, random_stream *random);

/* Places one vertex at one end, x0 or x1, given its coordinates in the plane and its height along the axis. */
void polygon_place(const polygon *p, double *x, uint32_t corner, double right, double up, double height);

/* A polygon in the plane across z. */
polygon polygon_at_rest(const double (*corners)[2], uint32_t count);

/* Is it simple at each of many moments? */
bool polygon_stays_simple(const polygon *p);
