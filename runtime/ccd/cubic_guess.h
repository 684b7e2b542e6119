/* Where a cubic's roots may be: guesses that others prove. One of two files behind it: with GSL or without.
 */
#pragma once

/* Approximate real roots of c[0] + c[1] t + c[2] t^2 + c[3] t^3, any leading coefficients 0 or tiny. Nothing
 * is certain of them, nor that none is missing. Returns how many were written, ascending. */
int cubic_guess_roots(const double c[4], double roots[3]);
