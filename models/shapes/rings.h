/* Meshes of rings of vertices: surfaces of revolution, and what follows from them by bending. */
#pragma once

#include "models/shapes/body.h"
#include "models/shapes/outline.h"

/* Writes where the point at (radius, height), turned by `angle` radians about the axis, goes. NULL:
 * the axis is z. */
typedef void rings_place(double radius, double height, double angle, double point[3]);

/* Adds the outline revolved, with exactly triangle_count triangles: an even number, at least 2 * 3 for each
 * ring. Rings have sizes in proportion to their radii and sum up to half the count:
 * a sphere of V vertices has 2 V - 4 triangles, a torus 2 V. */
void body_add_rings(body *b, const outline *o, uint32_t triangle_count, rings_place *place);
