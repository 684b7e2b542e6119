/* Which vertices belong to a component that is collapsed at a moment, by code of its own. */
#pragma once

#include "tests/support/scenes.h"

/* Marks, per vertex of the scene, those of components whose triangles all have no area at the positions; false for vertices
 * without a triangle. names: per vertex, for wires; NULL: there are none. */
void collapsed_oracle(const scene *s, const double *positions, const uint32_t *names, bool *vertices);

/* The same of both ends of the scene's interval together. */
void collapsed_oracle_at_ends(const scene *s, const uint32_t *names, bool *vertices);
