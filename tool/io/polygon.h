/* Cuts a face of a mesh file into triangles by its shape; and what that rests on: exact orientations, a tree
 * of corners, and ears. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- faces into triangles ------------------------------------------------------------------------------ */

typedef enum polygon_result {
    POLYGON_FILLED, /* by triangles that do not overlap in the plane of two coordinates */
    POLYGON_FANNED, /* by a fan around the first corner: the polygon is simple in no such plane, or has no area there */
    POLYGON_OUT_OF_MEMORY
} polygon_result;

/* Cuts a polygon of corner_count corners, at least 3, into corner_count - 2 triangles of its vertices, with
 * its orientation. positions: of all vertices, three doubles each. The polygon is looked at in the plane of
 * two coordinates that shows most of its area, so coordinates stay exact, and all decisions are exact. A
 * triangle stays as it is; a polygon that is convex without corners on a line, and has at most 128, becomes a
 * fan around its first corner; a quad gets the diagonal that lies inside. Holes may be bridged: the corners
 * go to the hole and come back on the same way. A polygon that crosses itself becomes a fan; of more than 128
 * corners it may also be filled, by triangles that lie twofold in places. */
polygon_result polygon_fill(const double *positions, const uint32_t *corners, uint32_t corner_count,
                            uint32_t (*triangles)[3]);

/* ---- the exact orientation of three points in a plane -------------------------------------------------- */

/* Returns 1 if c lies to the left of the line from a to b, -1 if to the right, 0 if on it: the sign of (b -
 * a) x (c - a), without rounding, for coordinates that are 0 or have a magnitude from 2^-300 to 2^300. */
int orientation_of(const double a[2], const double b[2], const double c[2]);

/* ---- a tree over the corners of a polygon -------------------------------------------------------------- */

/* A stretch of the outline, and its box, which is turned as the stretch runs. */
typedef struct corner_node {
    double direction[2];    /* of the box's first side, about of length 1 */
    double low[2], high[2]; /* along the direction, and across it to the left */
    uint32_t first, end;    /* of its corners */
    uint32_t parent, child, active_count;
} corner_node;

typedef struct corner_tree {
    const double (*points)[2];
    uint32_t *node_of; /* the leaf of each point */
    bool *active;
    corner_node *nodes;
    uint32_t node_count;
    double slack; /* by more than twice of which no projection is wrong */
} corner_tree;

/* No point is active at first. On false memory ran out, and *out holds nothing to free. */
bool corner_tree_create(const double (*points)[2], uint32_t count, corner_tree *out);
void corner_tree_free(corner_tree *tree);

void corner_tree_set_active(corner_tree *tree, uint32_t point, bool active);

/* Finds an active point in the closed triangle, whose corners run counter-clockwise, that is not at the place
 * of one of them; UINT32_MAX if there is none. */
uint32_t corner_tree_find(const corner_tree *tree, const uint32_t triangle[3]);

/* ---- ears ---------------------------------------------------------------------------------------------- */

/* Fills a polygon whose corners run counter-clockwise with corner_count - 2 triangles of positive area,
 * without new points. Triangles are three corners each, counted from 0. The polygon is simple, or weakly
 * simple: it may go to a hole and come back on the same way, and may touch itself at corners that lie at one
 * place. Corners on a line are used like any other. False: it crosses or overlaps itself in ways that no such
 * triangles fill, or memory ran out; *out_of_memory says which. Of all ears the one with the shortest
 * diagonal is clipped first, which keeps triangles compact and searches local: n log n for polygons that are
 * not made to be slow. */
bool ear_clipping_fill(const double (*points)[2], uint32_t corner_count, uint32_t (*triangles)[3],
                       bool *out_of_memory);
