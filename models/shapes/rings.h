/* Bodies of revolution: curves in the half plane (radius, height), and rings of vertices around the axis. */
#pragma once

#include "models/shapes/body.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- outlines, of straight lines and arcs -------------------------------------------------------------- */

enum { OUTLINE_PIECES_MAX = 32 };

typedef struct outline_piece {
    double from[2], to[2];                    /* a line, */
    double centre[2], size, angle[2], length; /* or an arc where size > 0; radians, 0 outwards, pi/2 up */
} outline_piece;

/* Grows from {.end = start}. An open outline runs from the lower to the upper pole, which both have radius
 * 0; a closed one runs counter-clockwise. So the inside is on the left. */
typedef struct outline {
    bool closed; /* the last end is the first start */
    uint32_t piece_count;
    double end[2], length;
    outline_piece pieces[OUTLINE_PIECES_MAX];
} outline;

/* Adds a straight line from the end so far to a point. */
void outline_line(outline *o, double radius, double height);

/* Adds an arc about a point between two angles in degrees, after a line to its start if there is a gap. */
void outline_arc(outline *o, double centre_radius, double centre_height, double size, double from, double to);

/* Adds an arc that continues the last piece smoothly and turns by these degrees, to the left if positive. */
void outline_turn(outline *o, double size, double by);

/* Finds the point at a distance along the outline, from 0 to length. */
void outline_at(const outline *o, double along, double point[2]);

/* Returns the length from the start of a piece to the next corner, where the outline turns by more than 20
 * degrees, or to its end. Sets *piece to the piece after that. */
double outline_section(const outline *o, uint32_t *piece);

/* ---- rings --------------------------------------------------------------------------------------------- */

/* Writes where the point at (radius, height), turned by `angle` radians about the axis, goes. NULL:
 * the axis is z. */
typedef void rings_place(double radius, double height, double angle, double point[3]);

/* Adds the outline revolved, with exactly triangle_count triangles: an even number, at least 2 * 3 for each
 * ring. Rings have sizes in proportion to their radii and sum up to half the count:
 * a sphere of V vertices has 2 V - 4 triangles, a torus 2 V. */
void body_add_rings(body *b, const outline *o, uint32_t triangle_count, rings_place *place);
