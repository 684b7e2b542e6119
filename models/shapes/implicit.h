/* Meshes of implicit surfaces. */
#pragma once

#include "models/shapes/body.h"

/* Smooth, negative inside; about the distance near its zero set, which lies well within the box. */
typedef struct implicit {
    double (*distance)(const double point[3]);
    double low[3], high[3];
} implicit;

/* Adds the zero set by surface nets on a grid of that spacing or a slightly smaller one. Its triangles are
 * uneven: see remesh.h. */
void body_add_implicit(body *b, const implicit *surface, double spacing);

/* Moves a point near the zero set onto it; `scale` is the length that derivatives are taken over. */
void implicit_project(const implicit *surface, double scale, double p[3]);
