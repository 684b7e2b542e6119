/* The shapes of which scenes consist. */
#include "tests/support/scenes.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

void scene_clear(scene *s) {
    s->vertex_count = s->triangle_count = 0;
}

static uint32_t add_vertex(scene *s, double x, double y, double z) {
    assert(s->vertex_count < SCENE_VERTICES_MAX);
    double p[3] = {x, y, z};
    memcpy(s->x0 + (size_t)s->vertex_count * 3, p, sizeof p);
    memcpy(s->x1 + (size_t)s->vertex_count * 3, p, sizeof p);
    return s->vertex_count++;
}

static void add_triangle(scene *s, uint32_t a, uint32_t b, uint32_t c) {
    assert(s->triangle_count < SCENE_TRIANGLES_MAX);
    uint32_t t[3] = {a, b, c};
    memcpy(s->triangles + (size_t)s->triangle_count++ * 3, t, sizeof t);
}

static void add_quad(scene *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    add_triangle(s, a, b, c);
    add_triangle(s, a, c, d);
}

/* Adds a surface of revolution about the z axis between two poles; z and radius of each ring are given. */
static void add_revolved(scene *s, const double centre[3], double low_pole, double high_pole, int rings,
                         int segments, const double (*profile)[2]) {
    uint32_t low = add_vertex(s, centre[0], centre[1], centre[2] + low_pole), first = s->vertex_count;
    for (int i = 0; i < rings; i++) {
        for (int j = 0; j < segments; j++) {
            double angle = 2.0 * PI * (j + 0.5 * (i % 2)) / segments;
            add_vertex(s, centre[0] + profile[i][1] * cos(angle), centre[1] + profile[i][1] * sin(angle),
                       centre[2] + profile[i][0]);
        }
    }
    uint32_t high = add_vertex(s, centre[0], centre[1], centre[2] + high_pole), n = (uint32_t)segments;
    for (uint32_t j = 0; j < n; j++) {
        uint32_t k = (j + 1) % n, last = first + (uint32_t)(rings - 1) * n;
        add_triangle(s, low, first + k, first + j);
        add_triangle(s, high, last + j, last + k);
        for (uint32_t i = 0; i + 1 < (uint32_t)rings; i++) {
            uint32_t row = first + i * n, next = row + n;
            add_quad(s, row + j, row + k, next + k, next + j);
        }
    }
}

void scene_add_sphere(scene *s, const double centre[3], double radius, int rings, int segments) {
    double profile[64][2];
    assert(rings <= 64);
    for (int i = 0; i < rings; i++) {
        double latitude = PI * ((i + 1.0) / (rings + 1.0) - 0.5);
        profile[i][0] = radius * sin(latitude);
        profile[i][1] = radius * cos(latitude);
    }
    add_revolved(s, centre, -radius, radius, rings, segments, (const double(*)[2])profile);
}

void scene_add_capsule(scene *s, double length, double radius, int rings, int segments) {
    static const double centre[3] = {0, 0, 0};
    double profile[64][2];
    assert(rings <= 64);
    for (int i = 0; i < rings; i++) {
        double z = length * ((i + 0.5) / rings - 0.5), past = fabs(z) - (0.5 * length - radius);
        profile[i][0] = z;
        profile[i][1] = past > 0 ? sqrt(fmax(radius * radius - past * past, 0.01 * radius * radius)) : radius;
    }
    add_revolved(s, centre, -0.5 * length, 0.5 * length, rings, segments, (const double(*)[2])profile);
}

void scene_add_torus(scene *s, const double centre[3], double major, double minor, int rings, int segments,
                     bool standing) {
    uint32_t first = s->vertex_count, m = (uint32_t)rings, n = (uint32_t)segments;
    for (uint32_t i = 0; i < m; i++) {
        double around = 2.0 * PI * i / m;
        for (uint32_t j = 0; j < n; j++) {
            double across = 2.0 * PI * j / n, reach = major + minor * cos(across);
            double p[3] = {reach * cos(around), reach * sin(around), minor * sin(across)};
            if (standing) /* a rotation, so the orientation does not change */
                add_vertex(s, centre[0] + p[0], centre[1] - p[2], centre[2] + p[1]);
            else
                add_vertex(s, centre[0] + p[0], centre[1] + p[1], centre[2] + p[2]);
        }
    }
    for (uint32_t i = 0; i < m; i++) {
        for (uint32_t j = 0; j < n; j++) {
            uint32_t row = first + i * n, next = first + (i + 1) % m * n, k = (j + 1) % n;
            add_quad(s, row + j, next + j, next + k, row + k);
        }
    }
}

void scene_add_sheet(scene *s, double width, double height, int columns, int rows) {
    uint32_t first = s->vertex_count, n = (uint32_t)columns + 1;
    for (int i = 0; i <= rows; i++) {
        for (int j = 0; j <= columns; j++)
            add_vertex(s, width * ((double)j / columns - 0.5), height * ((double)i / rows - 0.5), 0.0);
    }
    for (uint32_t i = 0; i < (uint32_t)rows; i++) {
        for (uint32_t j = 0; j < (uint32_t)columns; j++) {
            uint32_t corner = first + i * n + j;
            add_quad(s, corner, corner + 1, corner + n + 1, corner + n);
        }
    }
}
