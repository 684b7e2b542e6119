/* Polynomials in an infinitely small epsilon with integer coefficients: the moved coordinates of docs/theory/curves.md,
 * written out. They share nothing with src/mesh/symbolic.c but the definition. */
#pragma once

#include <stdint.h>

enum { EPSILON_TERMS = 1024, EPSILON_NAMES = 20 };

/* The sum of coefficient * epsilon^power, powers ascending, no coefficient 0. */
typedef struct epsilon_polynomial {
    int count;
    struct {
        uint64_t power;
        int64_t coefficient;
    } terms[EPSILON_TERMS];
} epsilon_polynomial;

/* A point with small integer coordinates, and a name below EPSILON_NAMES. */
typedef struct grid_point {
    int x[3];
    uint32_t name;
} grid_point;

/* A point whose coordinates are polynomials. */
typedef struct epsilon_point {
    epsilon_polynomial x[3];
} epsilon_point;

/* The moved point. */
void epsilon_move(grid_point p, epsilon_point *out);

/* Adds epsilon^power * factor * p to sum; the two are different. */
void epsilon_add(epsilon_polynomial *sum, const epsilon_polynomial *p, int factor, uint64_t power);

/* (b - a) x (c - a) . (d - a). */
void epsilon_orient3d(const epsilon_point *const p[4], epsilon_polynomial *out);

/* (b - a) x (c - a) in the projection along an axis. */
void epsilon_orient_along(const epsilon_point *const p[3], int axis, epsilon_polynomial *out);

/* The same of grid points, moved. */
void grid_orient3d(const grid_point p[4], epsilon_polynomial *out);
void grid_orient_along(const grid_point p[3], int axis, epsilon_polynomial *out);

/* The sign for all small enough epsilon > 0. */
int epsilon_sign(const epsilon_polynomial *p);
