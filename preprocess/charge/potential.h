/* The potential of a uniformly charged triangle, in closed form. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* A triangle with a charge of 1 per unit of area, prepared for many points. */
typedef struct potential_source {
    double corners[3][3];
    double along[3][3];   /* l: unit vector of edge i, from corner i to the next */
    double outward[3][3]; /* u = l x n: unit vector in the plane, away from the triangle */
    double lengths[3];
    double normal[3]; /* n */
    double area;
} potential_source;

/* False, and nothing is set, when the triangle's height over its longest edge is below 2^-40 of that edge:
 * its plane is then lost in rounding. */
bool potential_source_set(potential_source *source, const double corners[3][3]);

/* potentials[i] = the integral of dS' / |p_i - r'| over the triangle, p_i = (x[i], y[i], z[i]); finite
 * everywhere, on corners and edges too. Lengths and distances are from 2^-60 to 2^60. Absolute error: some
 * roundings of the triangle's longest edge; relative error at a distance R: some R / (longest edge)
 * roundings. The same bits on every processor. */
void potential_at(const potential_source *source, const double *x, const double *y, const double *z,
                  size_t count, double *potentials);
