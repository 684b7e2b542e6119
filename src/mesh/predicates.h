/* Exact orientation predicates on doubles: a floating-point filter first, exact expansions behind it. */
#pragma once

#include <stdbool.h>

/* All coordinates must be 0 or have a magnitude in [2^-300, 2^300]: then no exact product of three of them
 * over- or underflows. */

/* Sign (-1, 0, 1) of the determinant |b-a, c-a|, a, b, c in the plane: 1 when they turn counter-clockwise. */
int orient2d(double ax, double ay, double bx, double by, double cx, double cy);

/* Sign (-1, 0, 1) of (b-a) x (c-a) . (d-a): 1 when d lies on the side from which a, b, c turn
 * counter-clockwise. */
int orient3d(const double a[3], const double b[3], const double c[3], const double d[3]);

/* Do the three points lie on one line, or coincide? */
bool collinear(const double a[3], const double b[3], const double c[3]);
