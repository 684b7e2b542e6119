/* Guesses where a cubic's roots are; callers prove them. */
#pragma once

/* What callers tell of a root must not depend on how it was guessed. So a time that follows from a guess is rounded
 * down to a multiple of this: the cell that the root is proven to be in names it, and every right guess has the same
 * cell. */
#define ROOT_CELL 0x1p-34

/* Writes approximate real roots of c[0] + c[1] t + c[2] t^2 + c[3] t^3 in ascending order, and returns how many.
 * Leading coefficients may be 0 or tiny. Roots outside of [0, 1] are only known to be outside, others may be wrong, and some may be
 * missing. */
int cubic_guess_roots(const double c[4], double roots[3]);
