/* Meshes of implicit surfaces. */
#pragma once

#include "models/shapes/body.h"

/* A smooth function that is negative inside and, near its zero set, about the distance. The zero set lies
 * well within the box. */
typedef struct implicit {
    double (*distance)(const double point[3]);
    double low[3], high[3];
} implicit;

/* Adds the zero set by surface nets on a grid of this spacing or a slightly smaller one. Its triangles are
 * uneven; remesh.h makes them even. */
void body_add_implicit(body *b, const implicit *surface, double spacing);

/* Moves a point near the zero set onto it; `scale` is the length over which derivatives are taken. */
void implicit_project(const implicit *surface, double scale, double p[3]);
