/* Meshes of implicit surfaces, by surface nets, and made even with an exact number of triangles. */
#pragma once

#include "models/shapes/body.h"

/* The magnitude of `distance` is nowhere more than this many times the distance to the zero set. */
#define IMPLICIT_STEEPEST 2.5

/* A continuous function that is negative inside and, near its zero set, about the distance. The zero set lies well
 * within the box; where the function has a crease, as in the edges of letters, so has the surface. */
typedef struct implicit {
    double (*distance)(const double point[3]);
    double low[3], high[3];
    bool narrow; /* parts nearly touch: a grid that is too coarse joins them */
} implicit;

/* Adds the zero set by surface nets on a grid of this spacing, or of the next smaller one in which no two sheets meet;
 * returns the spacing. The triangles are uneven; remesh.h makes them even. */
double body_add_implicit(body *b, const implicit *surface, double spacing);

/* Moves a point near the zero set onto it; `scale` is the length over which derivatives are taken. */
void implicit_project(const implicit *surface, double scale, double p[3]);

/* ---- even triangles ------------------------------------------------------------------------------------ */

/* Replaces a closed manifold near the zero set by one on it with exactly triangle_count triangles, about
 * equilateral and of one size. False, with *b as it comes out, when the count cannot be reached: it is odd,
 * or far too small. */
bool body_remesh(body *b, const implicit *surface, uint32_t triangle_count);

/* Makes nets and then remeshes them with body_remesh. */
bool body_add_even_implicit(body *b, const implicit *surface, uint32_t triangle_count);
