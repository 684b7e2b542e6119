/* Orientation predicates that are never 0: each point is thought to be moved by an infinitely small amount of its own.
 *
 * Simulation of Simplicity (H. Edelsbrunner, E. P. Muecke, ACM Transactions on Graphics 9, 1990): coordinate k of the
 * point with the name n is moved by epsilon^(2^(3 n + k)). A determinant of moved points is a polynomial in epsilon,
 * and its sign for all small enough epsilon is that of its first coefficient that is not 0. The coefficients are
 * minors of the same matrix, whose signs src/mesh/predicates.h knows exactly. docs/theory/curves.md has the proof. */
#pragma once

#include "src/mesh/predicates.h"

#include <stdint.h>

/* Points of one call have different names, but may lie at the same place. */
typedef struct symbolic_point {
    const double *x; /* coordinates as src/mesh/predicates.h allows them */
    uint32_t name;
} symbolic_point;

/* The first term of a determinant of four points that is not 0. */
typedef struct symbolic_term {
    int sign;         /* that of the determinant, -1 or 1 */
    uint8_t order[4]; /* the points by ascending names */
    uint8_t moved;    /* bit 3 r + k: a factor of the term is what moves coordinate k of point order[r] */
} symbolic_term;

symbolic_term symbolic_orient3d_term(const symbolic_point p[4]);

/* What is left of the matrix of four points: rows, that is, points, and one column less than rows, beside that of
 * ones. The minor's magnitude is the coefficient of the term. */
typedef struct symbolic_minor {
    uint8_t points[4], columns[3];
    int point_count;
} symbolic_minor;

symbolic_minor symbolic_minor_of(const symbolic_term *term);

/* orient3d of the moved points: -1 or 1. */
static inline int symbolic_orient3d(symbolic_point a, symbolic_point b, symbolic_point c, symbolic_point d) {
    int sign = orient3d(a.x, b.x, c.x, d.x);
    return sign != 0 ? sign : symbolic_orient3d_term((symbolic_point[4]){a, b, c, d}).sign;
}

/* orient2d of the moved points in the projection along an axis, with coordinate axis + 1 to the right and axis + 2
 * upwards (modulo 3): -1 or 1. */
int symbolic_orient_along(symbolic_point a, symbolic_point b, symbolic_point c, int axis);

/* Compares the powers of epsilon of two terms, the first of the points p, the second of the points q: -1 when the first
 * term is infinitely larger, 1 when the second one is, 0 when both have the same power. */
int symbolic_compare_terms(const symbolic_term *first, const symbolic_point p[4], const symbolic_term *second,
                           const symbolic_point q[4]);
