/* Meshes of implicit surfaces made even, with an exact number of triangles. */
#pragma once

#include "models/shapes/implicit.h"

/* Replaces a closed manifold near the zero set by one on it with exactly triangle_count triangles, about
 * equilateral and of one size. False, with *b as it comes out, when the count cannot be reached: it is odd,
 * or far too small. */
bool body_remesh(body *b, const implicit *surface, uint32_t triangle_count);

/* Makes nets and then remeshes them with body_remesh. */
bool body_add_even_implicit(body *b, const implicit *surface, uint32_t triangle_count);
