/* Rotations that are the same on every machine. */
#pragma once

/* Computes the matrix of a rotation about an axis of any length; an axis of length 0 gives the identity.
 * The matrix is rounded to single precision, because sines and cosines of different libraries differ in
 * their last bits. */
void turn_matrix(const double axis[3], double degrees, double out[3][3]);
