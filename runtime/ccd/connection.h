/* The vector between two points that are named by weights of the four vertices of a pair. */
#pragma once

/* Writes the vector from the second feature's point to the first one's. x: the vertices, of which the first `own` belong to
 * the first feature; its weights add up to 1, the others' to -1. Sums differences of coordinates, so that the result is
 * as exact as these are. */
void connection_between(const double *const x[4], const double weights[4], int own, double out[3]);

/* Returns the length of a vector of any size: nothing over- or underflows. */
double connection_length(const double vector[3]);
