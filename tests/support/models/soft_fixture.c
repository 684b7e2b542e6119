/* Soft bodies for tests, far above the ground, and the quantities that the laws of motion keep. */
#include "tests/support/models/soft_fixture.h"

#include "models/common/vec3.h"

#include <string.h>

const double soft_fixture_height = 20.0;

void affine_map(double matrix[3][3], const double offset[3], const double *from, uint32_t point_count,
                double *to) {
    for (uint32_t i = 0; i < point_count; i++) {
        double moved[3];
        for (int k = 0; k < 3; k++) moved[k] = vec3_dot(matrix[k], from + i * 3) + offset[k];
        memcpy(to + i * 3, moved, sizeof moved);
    }
}

void rotation_matrix(const double axis[3], double angle, double out[3][3]) {
    double unit[3] = {axis[0], axis[1], axis[2]};
    vec3_normalize(unit);
    for (int column = 0; column < 3; column++) {
        double base[3] = {column == 0, column == 1, column == 2}, turned[3];
        vec3_cross(unit, base, turned);
        for (int k = 0; k < 3; k++)
            out[k][column] =
                cos(angle) * base[k] + sin(angle) * turned[k] + (1.0 - cos(angle)) * unit[column] * unit[k];
    }
}

body box_body(const double low[3], const double high[3]) {
    static const uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    body b = {0};
    for (int i = 0; i < 8; i++)
        body_add_vertex(&b, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
    for (int i = 0; i < 6; i++) {
        body_add_triangle(&b, sides[i][0], sides[i][1], sides[i][2]);
        body_add_triangle(&b, sides[i][0], sides[i][2], sides[i][3]);
    }
    return b;
}

void soft_body_lift(soft_body *b, double height) {
    double same[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    soft_body_place(b, same, (double[3]){0.0, 0.0, height});
}

soft_body soft_body_of(const body *b, double spacing, const material *m) {
    soft_body soft =
        soft_body_make(b->positions, b->vertex_count, b->triangles, b->triangle_count, spacing, m);
    soft_body_lift(&soft, soft_fixture_height);
    return soft;
}

soft_momentum soft_momentum_of(const soft_body *b) {
    soft_momentum m = {0};
    for (uint32_t n = 0; n < b->frame.node_count; n++) {
        m.mass += b->masses[n];
        vec3_add_scaled(m.centre, b->masses[n], b->nodes + n * 3);
        vec3_add_scaled(m.linear, b->masses[n], b->velocities + n * 3);
    }
    for (int k = 0; k < 3; k++) m.centre[k] /= m.mass;
    for (uint32_t n = 0; n < b->frame.node_count; n++) {
        double arm[3], turning[3];
        vec3_subtract(b->nodes + n * 3, m.centre, arm);
        vec3_cross(arm, b->velocities + n * 3, turning);
        vec3_add_scaled(m.angular, b->masses[n], turning);
    }
    return m;
}

double largest_distance(const double *a, const double *b, uint32_t point_count) {
    double largest = 0.0;
    for (uint32_t i = 0; i < point_count; i++) {
        double apart[3];
        vec3_subtract(a + i * 3, b + i * 3, apart);
        largest = fmax(largest, vec3_norm(apart));
    }
    return largest;
}

double lowest_vertex(const soft_body *b) {
    double lowest = b->vertices[2];
    for (uint32_t v = 1; v < b->frame.vertex_count; v++) lowest = fmin(lowest, b->vertices[v * 3 + 2]);
    return lowest;
}
