/* Rotations that are the same on every machine. */
#pragma once

/* About an axis of any length but 0, which is no rotation. Rounded to single precision: sines and cosines of
 * different libraries differ in their last bits. */
void turn_matrix(const double axis[3], double degrees, double out[3][3]);
