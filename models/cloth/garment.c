/* Sheets, tubes, boxes and balls as meshes: garments and obstacles. */
#include "models/cloth/garment.h"
#include "models/shapes/catalogue.h"
#include "models/shapes/rings.h"

/* Adds two triangles for each cell of a lattice of vertices, which stand in rows from `first` on. turned:
 * counter-clockwise seen from the other side. */
static void add_cells(body *b, uint32_t first, uint32_t columns, uint32_t rows, bool turned) {
    for (uint32_t j = 0; j + 1 < rows; j++) {
        for (uint32_t i = 0; i + 1 < columns; i++) {
            uint32_t v00 = first + j * columns + i, v10 = v00 + 1, v01 = v00 + columns, v11 = v01 + 1;
            uint32_t left = turned ? v01 : v10, right = turned ? v10 : v01;
            bool rising = (i + j) % 2 == 0;
            body_add_triangle(b, v00, left, rising ? v11 : right);
            body_add_triangle(b, rising ? v00 : left, v11, right);
        }
    }
}

void garment_add_sheet(body *b, uint32_t side, double width) {
    uint32_t first = b->vertex_count;
    double spacing = width / (side - 1);
    for (uint32_t j = 0; j < side; j++) {
        for (uint32_t i = 0; i < side; i++)
            body_add_vertex(b, i * spacing - 0.5 * width, j * spacing - 0.5 * width, 0.0);
    }
    add_cells(b, first, side, side, false);
    body_round(b);
}

void garment_add_bag(body *b, uint32_t columns, uint32_t rows, double width, double height, double depth) {
    for (int side = 0; side < 2; side++) {
        uint32_t first = b->vertex_count;
        for (uint32_t j = 0; j < rows; j++) {
            double up = (double)j / (rows - 1), open = 1.0 - up * up;
            for (uint32_t i = 0; i < columns; i++) {
                double across = 2.0 * i / (columns - 1) - 1.0, bulge = depth * open * (1.0 - across * across);
                body_add_vertex(b, 0.5 * width * across, side == 0 ? 0.0 - bulge : bulge, height * up);
            }
        }
        add_cells(b, first, columns, rows, side == 1);
    }
    body_round(b);
}

uint32_t *garment_bag_seams(uint32_t columns, uint32_t rows, uint32_t *pair_count) {
    uint32_t *seams = body_allocate(2 * (2 * (size_t)rows + columns), sizeof *seams), count = 0;
    for (uint32_t v = 0; v < columns * rows; v++) {
        uint32_t column = v % columns, row = v / columns;
        if (column > 0 && column + 1 < columns && row + 1 < rows) continue;
        seams[2 * count] = v;
        seams[2 * count++ + 1] = columns * rows + v;
    }
    *pair_count = count;
    return seams;
}

void garment_add_tube(body *b, uint32_t triangle_count, double radius, double height) {
    const double rim = 0.15 * radius;
    outline o = {.end = {0.0, 0.0}};
    outline_arc(&o, radius - rim, rim, rim, -90.0, 0.0);
    outline_arc(&o, radius - rim, height - rim, rim, 0.0, 90.0);
    outline_line(&o, 0.0, height);
    body_add_rings(b, &o, triangle_count, NULL);
    body_round(b);
}

/* The bits of a corner's number, 0 to 7, are its x, y and z. */
void garment_add_box(body *b, double reach) {
    static const uint8_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const double thickness = 0.1 * reach;
    uint32_t first = b->vertex_count;
    for (uint32_t i = 0; i < 8; i++)
        body_add_vertex(b, i & 1 ? reach : -reach, i & 2 ? reach : -reach, i & 4 ? 0.0 : -thickness);
    for (uint32_t i = 0; i < 6; i++) {
        const uint8_t *s = sides[i];
        body_add_triangle(b, first + s[0], first + s[1], first + s[2]);
        body_add_triangle(b, first + s[0], first + s[2], first + s[3]);
    }
    body_round(b);
}

bool garment_add_ball(body *b, uint32_t triangle_count, double radius, io_error *error) {
    body sphere;
    if (!body_make(BODY_SPHERE, body_nearest_count(BODY_SPHERE, triangle_count), &sphere, error))
        return false;
    for (uint32_t i = 0; i < sphere.vertex_count * 3; i++) sphere.positions[i] *= radius;
    body_append(b, &sphere, (double[3]){0.0, 0.0, 0.0});
    body_round(b);
    body_free(&sphere);
    return true;
}
