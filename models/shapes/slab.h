/* Boxes of equal squares, flat and folded. */
#pragma once

#include "models/shapes/body.h"

/* n along each edge: 12 n^2 triangles. */
void add_cube(body *b, uint32_t n);

/* n along the length, 28 or more, the other edges divided as finely: slab_triangles(n) triangles. */
void add_slab(body *b, uint32_t n);
uint32_t slab_triangles(uint32_t n);
