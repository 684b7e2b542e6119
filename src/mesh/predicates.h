/* Exact predicates on doubles: orientations of points, whether triangles intersect, and orientations that are never 0. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* All coordinates must be 0 or have a magnitude in [2^-300, 2^300]: then no exact product of three of them
 * over- or underflows. */

/* Sign (-1, 0, 1) of the determinant |b-a, c-a|, a, b, c in the plane: 1 when they turn counter-clockwise. */
int orient2d(double ax, double ay, double bx, double by, double cx, double cy);

/* Sign (-1, 0, 1) of (b-a) x (c-a) . (d-a): 1 when d lies on the side from which a, b, c turn
 * counter-clockwise. */
int orient3d(const double a[3], const double b[3], const double c[3], const double d[3]);

/* Tells whether the three points lie on one line, or coincide. */
bool collinear(const double a[3], const double b[3], const double c[3]);

/* ---- triangles --------------------------------------------------------------------------------------------- */

/* Tells, exactly, whether two triangles of one mesh intersect: an edge or a vertex of one has a point in common with the face of
 * the other, or an edge with an edge. Two features that share a vertex (by index) never count. Features are closed, so touching
 * counts. a and b are the vertex indices of two different triangles, positions the packed xyz of the whole mesh. */
bool triangles_intersect(const uint32_t a[3], const uint32_t b[3], const double *positions);

/* The same, but vertices with the same name count as one vertex, wherever they are. */
bool triangles_intersect_by_names(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                                  const double *positions);

/* ---- predicates that are never 0 --------------------------------------------------------------------------- */

/* Each point is thought to be moved by an infinitely small amount of its own.
 *
 * Simulation of Simplicity (H. Edelsbrunner, E. P. Muecke, ACM Transactions on Graphics 9, 1990): coordinate k of the
 * point with the name n is moved by epsilon^(2^(3 n + k)). A determinant of moved points is a polynomial in epsilon,
 * and its sign for all small enough epsilon is that of its first coefficient that is not 0. The coefficients are
 * minors of the same matrix, whose signs orient2d and orient3d know exactly. docs/theory/curves.md has the proof.
 *
 * Points of one call have different names, but may lie at the same place. */
typedef struct symbolic_point {
    const double *x; /* coordinates as predicates.h allows them */
    uint32_t name;
} symbolic_point;

/* The first term of a determinant of four points that is not 0. */
typedef struct symbolic_term {
    int sign;         /* that of the determinant, -1 or 1 */
    uint8_t order[4]; /* the points by ascending names */
    uint8_t moved;    /* bit 3 r + k: a factor of the term is what moves coordinate k of point order[r] */
} symbolic_term;

symbolic_term symbolic_orient3d_term(const symbolic_point p[4]);

/* The rest of the matrix of four points: rows, that is, points, and one column less than rows, besides that of
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

/* ---- sums and products without error ----------------------------------------------------------------------- */

/* Sums and products of two doubles with their rounding errors, for such coordinates and products of three of them.
 *
 * sum + error = a + b exactly, |a| >= |b| or a = 0 (Dekker). */
static inline void fast_two_sum(double a, double b, double *sum, double *error) {
    double s = a + b;

    *error = b - (s - a);
    *sum = s;
}

/* sum + error = a + b exactly (Knuth). */
static inline void two_sum(double a, double b, double *sum, double *error) {
    double s = a + b;
    double b_part = s - a;
    double a_part = s - b_part;

    *error = (a - a_part) + (b - b_part);
    *sum = s;
}

/* high + low = a, 26 bits each (Veltkamp). */
static inline void split_double(double a, double *high, double *low) {
    double scaled = 134217729.0 * a; /* 2^27 + 1 */

    *high = scaled - (scaled - a);
    *low = a - *high;
}

/* product + error = a * b exactly (Dekker), with b split by the caller. fma() is slower on processors that
 * lack the instruction. */
static inline void two_product(double a, double b, double b_high, double b_low, double *product,
                               double *error) {
    double p = a * b;
    double a_high, a_low;

    split_double(a, &a_high, &a_low);
    *error = a_low * b_low - (((p - a_high * b_high) - a_low * b_high) - a_high * b_low);
    *product = p;
}
