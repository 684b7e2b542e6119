/* The exact orientation of three points in a plane. */
#pragma once

/* Returns 1 if c lies to the left of the line from a to b, -1 if to the right, 0 if on it: the sign of
 * (b - a) x (c - a), without rounding, for coordinates that are 0 or have a magnitude from 2^-300 to 2^300. */
int orientation_of(const double a[2], const double b[2], const double c[2]);
