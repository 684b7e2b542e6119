/* What falls and what it falls onto: sheets, tubes, boxes and balls as meshes. */
#include "models/textile/garment.h"
#include "models/shapes/catalogue.h"
#include "models/shapes/rings.h"

void garment_add_sheet(body *b, uint32_t side, double width) {
    uint32_t first = b->vertex_count;
    double spacing = width / (side - 1);
    for (uint32_t j = 0; j < side; j++) {
        for (uint32_t i = 0; i < side; i++)
            body_add_vertex(b, i * spacing - 0.5 * width, j * spacing - 0.5 * width, 0.0);
    }
    for (uint32_t j = 0; j + 1 < side; j++) {
        for (uint32_t i = 0; i + 1 < side; i++) {
            uint32_t v00 = first + j * side + i, v10 = v00 + 1, v01 = v00 + side, v11 = v01 + 1;
            bool rising = (i + j) % 2 == 0;
            body_add_triangle(b, v00, v10, rising ? v11 : v01);
            body_add_triangle(b, rising ? v00 : v10, v11, v01);
        }
    }
    body_round(b);
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

/* Corners as the bits of 0 to 7: x, y, z. */
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
