/* Small meshes without positions, put together from standard pieces. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { SHAPE_TRIANGLES_MAX = 256 };

/* A shape grows from {0} triangle by triangle; vertex_count is one more than the largest index. */
typedef struct shape {
    uint32_t vertex_count, triangle_count;
    uint32_t triangles[SHAPE_TRIANGLES_MAX][3];
} shape;

void shape_add_triangle(shape *s, uint32_t a, uint32_t b, uint32_t c);
void shape_add_quad(shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
void shape_add_tetrahedron(shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

/* Adds a cube; the bits of its vertices' numbers, 0 to 7, are x, y, z. */
void shape_add_cube(shape *s);

/* Adds rows x columns quads, whose ends may be joined: a sheet, a cylinder, a torus. */
void shape_add_grid(shape *s, uint32_t rows, uint32_t columns, bool rows_close, bool columns_close);

/* Adds `count` quads in a ring with half a twist. */
void shape_add_moebius_strip(shape *s, uint32_t count);
