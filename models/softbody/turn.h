/* Rotations that are the same on every machine. */
#ifndef CSCD_MODELS_TURN_H
#define CSCD_MODELS_TURN_H

/* About an axis of any length but 0, which is no rotation. Rounded to single precision: sines and cosines of
 * different libraries differ in their last bits. */
void turn_matrix(const double axis[3], double degrees, double out[3][3]);

#endif
