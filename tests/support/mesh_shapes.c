/* Small meshes without positions, put together from standard pieces. */
#include "tests/support/mesh_shapes.h"
#include "tests/support/test.h"

#include <string.h>

void shape_add_triangle(shape *s, uint32_t a, uint32_t b, uint32_t c) {
    assert_true(s->triangle_count < SHAPE_TRIANGLES_MAX);
    memcpy(s->triangles[s->triangle_count++], (uint32_t[]){a, b, c}, sizeof s->triangles[0]);
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t v = s->triangles[s->triangle_count - 1][i];
        if (v >= s->vertex_count) s->vertex_count = v + 1;
    }
}

void shape_add_quad(shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    shape_add_triangle(s, a, b, c);
    shape_add_triangle(s, a, c, d);
}

void shape_add_tetrahedron(shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    shape_add_triangle(s, a, b, c);
    shape_add_triangle(s, a, c, d);
    shape_add_triangle(s, a, d, b);
    shape_add_triangle(s, b, d, c);
}

void shape_add_cube(shape *s) {
    shape_add_quad(s, 0, 2, 3, 1);
    shape_add_quad(s, 4, 5, 7, 6);
    shape_add_quad(s, 0, 1, 5, 4);
    shape_add_quad(s, 2, 6, 7, 3);
    shape_add_quad(s, 0, 4, 6, 2);
    shape_add_quad(s, 1, 3, 7, 5);
}

void shape_add_grid(shape *s, uint32_t rows, uint32_t columns, bool rows_close, bool columns_close) {
    uint32_t width = columns_close ? columns : columns + 1, height = rows_close ? rows : rows + 1;
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            uint32_t below = (i + 1) % height * width, here = i * width, next = (j + 1) % width;
            shape_add_quad(s, here + j, here + next, below + next, below + j);
        }
    }
}

void shape_add_moebius_strip(shape *s, uint32_t count) {
    for (uint32_t i = 0; i + 1 < count; i++) shape_add_quad(s, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    shape_add_quad(s, 2 * count - 2, 1, 0, 2 * count - 1);
}
