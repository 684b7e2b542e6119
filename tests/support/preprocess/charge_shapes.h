/* Closed surfaces whose capacitance is known, at any refinement. */
#pragma once

#include "models/shapes/extreme_shapes.h"

#include <stdint.h>

/* The caller releases it by conductor_free. */
typedef struct conductor {
    uint32_t vertex_count, triangle_count;
    double *positions;   /* vertex_count * 3 */
    uint32_t *triangles; /* triangle_count * 3 */
} conductor;

/* Makes an icosahedron whose triangles are split in four, level times, with all vertices on the unit
 * sphere. */
conductor conductor_sphere(int level);

/* Makes the unit cube [0,1]^3 with 12 * 4^level triangles. */
conductor conductor_cube(int level);

/* Makes a tetrahedron of four triangles. */
conductor conductor_tetrahedron(void);

/* Makes a shape of about so many long triangles, at rest. */
conductor conductor_extreme(extreme_kind kind, uint32_t triangle_count);

/* Turns every position p into scale * p + offset, coordinate by coordinate. */
void conductor_transform(conductor *s, const double scale[3], const double offset[3]);

/* Moves a unit cube's vertices towards its edges, where the density is infinite: x = (1 - cos(pi x)) / 2. */
void conductor_crowd_edges(conductor *s);

/* Appends b to a, without a common vertex. */
void conductor_append(conductor *a, const conductor *b);

void conductor_free(conductor *s);
