/* Curves in the half plane (radius, height), of straight lines and arcs. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { OUTLINE_PIECES_MAX = 32 };

typedef struct outline_piece {
    double from[2], to[2];                    /* a line, */
    double centre[2], size, angle[2], length; /* or an arc where size > 0; radians, 0 outwards, pi/2 up */
} outline_piece;

/* Grows from {.end = start}: open ones from the lower pole to the upper one (both have radius 0), closed ones
 * counter-clockwise; so the inside is on the left. */
typedef struct outline {
    bool closed; /* the last end is the start */
    uint32_t piece_count;
    double end[2], length;
    outline_piece pieces[OUTLINE_PIECES_MAX];
} outline;

/* From the end so far, straight on to a point. */
void outline_line(outline *o, double radius, double height);

/* An arc about a point, from one angle to another, in degrees; a line leads there if need be. */
void outline_arc(outline *o, double centre_radius, double centre_height, double size, double from, double to);

/* Goes on smoothly from a last piece: an arc that turns by so many degrees, to the left where positive. */
void outline_turn(outline *o, double size, double by);

/* The point at a distance along it, 0 to length. */
void outline_at(const outline *o, double along, double point[2]);

/* The length from the start of a piece up to the next corner, where it turns by more than 20 degrees, or to
 * the end. Moves *piece on to what follows. */
double outline_section(const outline *o, uint32_t *piece);
