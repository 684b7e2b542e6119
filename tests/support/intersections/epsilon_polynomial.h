/* Polynomials in an infinitely small epsilon with integer coefficients: the moved coordinates of docs/theory/curves.md,
 * written out. They share nothing with src/mesh/symbolic.c but the definition. */
#pragma once

#include <stdint.h>

enum { EPSILON_TERMS = 128, EPSILON_NAMES = 20 };

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

/* (b - a) x (c - a) . (d - a) of the moved points. */
void epsilon_orient3d(const grid_point p[4], epsilon_polynomial *out);

/* (b - a) x (c - a) in the projection along an axis. */
void epsilon_orient_along(const grid_point p[3], int axis, epsilon_polynomial *out);

/* The sign for all small enough epsilon > 0. */
int epsilon_sign(const epsilon_polynomial *p);
