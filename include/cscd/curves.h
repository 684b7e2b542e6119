/* Intersection curves: where the surfaces of a mesh pass through each other at one moment. Part of cscd/cscd.h, which
 * says what holds for every function.
 *
 * A pair of triangles says what these two have in common; whether surfaces pass through each other is said by curves.
 * They are the curves of surfaces whose vertices are moved by infinitely small amounts, by one rule for the whole mesh
 * (Simulation of Simplicity, Edelsbrunner and Muecke 1990), so that nothing only touches: each two surfaces cross or are
 * apart. All is decided exactly, and points are those to which the curves go as the amounts go to 0. Vertices that seams
 * unite are one as long as they are at one place; where they are apart, they are two, for curves, patches, overlaps and
 * depths alike, and the surfaces go where their triangles go. Theory: docs/theory/curves.md.
 *
 * Degenerate meshes have curves, too. Of the moved surface every triangle has an area, no two triangles lie in one plane, and
 * different vertices are at different places; so triangles without area, duplicates and vertices at equal positions need no
 * rule of their own. Where an edge has three triangles or more, or one, curves end (cscd_curve_end). A triangle of
 * which seams unite two corners at one place is a line, and has no curve. */
#ifndef CSCD_CURVES_API_H
#define CSCD_CURVES_API_H

#include <cscd/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What is at the end of a curve. Later versions may add values. */
typedef enum cscd_curve_end {
    CSCD_CURVE_END_NONE,     /* it is closed */
    CSCD_CURVE_END_VERTEX,   /* a vertex that both triangles have: there the vertex's star crosses itself */
    CSCD_CURVE_END_BORDER,   /* an edge of one triangle only, the border of an open surface */
    CSCD_CURVE_END_JUNCTION, /* an edge of three triangles or more */
    CSCD_CURVE_END_LEFT_OUT, /* it would go on in a pair that is left out */
    CSCD_CURVE_END_MAX_ENUM = 0x7fffffff
} cscd_curve_end;

/* The name as in "border"; static storage, never NULL. */
CSCD_API const char *cscd_curve_end_name(cscd_curve_end end);

/* A point of a curve, where an edge passes through a triangle: (1-s) e0 + s e1 on the edge (e0, e1), and (1-u-v) p0 + u p1 +
 * v p2 on the triangle. Where the curve ends at a vertex, edge is UINT32_MAX, triangle is the vertex, and s, u, v are 0. Each
 * number is rounded once from its exact value. It never grows. */
typedef struct cscd_curve_point {
    uint32_t edge, triangle;
    double s, u, v;
    double x[3];
} cscd_curve_point;

/* A piece of a curve, from one of its points to the next, straight. It lies in two triangles: a is on the first side of
 * the curve, b on the second one. It never grows. */
typedef struct cscd_curve_piece {
    uint32_t a, b;
} cscd_curve_piece;

/* A curve is where two sheets of surface pass through each other. The triangles a of its pieces are its trace on the first
 * sheet, those b on the second one; from piece to piece the triangle of one sheet changes, over the edge of the point in
 * between. Where both sheets are consistently oriented, it runs in the direction of the normal of a times (cross product)
 * that of b: on sheet a the inside of b is to its left, seen from outside. It never grows. */
typedef struct cscd_curve {
    size_t first_point, point_count; /* in the list of all points; an open one has one more than pieces */
    size_t first_piece, piece_count; /* in the list of all pieces */
    cscd_curve_end start, end;       /* NONE for a closed one, whose last piece leads to its first point */
    uint32_t components[2];          /* of the two sheets */
    uint32_t objects[2];
    bool closed;
    bool
        swapped; /* closed, and after one turn the sheets have changed places, which needs a surface that has no
                          * orientation */
    bool touching; /* only where depths were asked for: the surfaces touch along it, and no more. No pair of
                          * triangles crosses, and nothing that it bounds has a depth */
    uint8_t reserved[5]; /* 0 */
    double length;       /* of its pieces, up to rounding */
} cscd_curve;

/* Curves in the order of their least pairs (a, b). The lists belong to the detector and live until its next call. */
typedef struct cscd_curves {
    const cscd_curve *items;
    size_t count;
    const cscd_curve_point *points;
    size_t point_count;
    const cscd_curve_piece *pieces;
    size_t piece_count;
    const uint32_t
        *pair_curves; /* per pair of the list of intersections: the curve that has a piece in it, or
                                  * UINT32_MAX */
    size_t pair_count;
} cscd_curves;

#ifdef __cplusplus
}
#endif

#endif
