/* Piercings, pieces and winding numbers of a small scene by brute force, on signs of leading_terms.h. It takes of the library
 * the mesh's edges, and no geometry. */
#pragma once

#include "runtime/intersections/named_surface.h"
#include "tests/support/intersections/grid_scene.h"
#include "tests/support/intersections/leading_terms.h"

enum { ORACLE_EDGES = 64, ORACLE_TRIANGLES = 32 };

/* An end of a piece: where an edge of one triangle passes through the other; edge_name is the least edge that it is one
 * with. Or, with AT_VERTEX, a vertex that both triangles have, whose name then stands in place of the triangle. */
typedef struct oracle_piercing {
    uint32_t edge_name, triangle;
} oracle_piercing;

enum { AT_VERTEX = UINT32_MAX };

/* The piece that two triangles a < b have in common, in the direction of the normal of a times that of b. */
typedef struct oracle_piece {
    uint32_t a, b;
    oracle_piercing ends[2];
} oracle_piece;

typedef struct surface_oracle {
    const grid_scene *scene;
    double scale; /* times this, coordinates are integers */
    leading_terms terms;
    uint32_t edge_names[ORACLE_EDGES];
    bool passes[ORACLE_EDGES][ORACLE_TRIANGLES]; /* the edge through the triangle */
} surface_oracle;

void surface_oracle_begin(surface_oracle *o, const grid_scene *s, double scale);

/* Finds the piece of two triangles; false: there is none. Aborts if there are piercings that lemmas 2 and 3 of
 * docs/theory/curves.md rule out. */
bool surface_oracle_piece(surface_oracle *o, uint32_t a, uint32_t b, oracle_piece *out);

/* The point of a piercing, rounded to the nearest doubles: s, u, v, then x, y, z. */
void surface_oracle_point(surface_oracle *o, uint32_t edge, uint32_t triangle, double out[6]);

/* The winding number of an object at the point, by a ray along x. */
int surface_oracle_number(surface_oracle *o, corner_side at, uint32_t object);
