/* Boxes of equal squares, flat and folded. */
#pragma once

#include "models/shapes/body.h"

/* Adds a cube with n squares along each edge: 12 n^2 triangles. */
void add_cube(body *b, uint32_t n);

/* Adds a slab with n squares along its length, 28 or more; the other edges are divided as finely. It has
 * slab_triangles(n) triangles. */
void add_slab(body *b, uint32_t n);
uint32_t slab_triangles(uint32_t n);
