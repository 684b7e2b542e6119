/* Scenes whose surfaces pass through each other, at one moment. */
#include "benchmarks/lib/crossing_scenes.h"

#include "benchmarks/lib/deforming_body.h"

#include <math.h>
#include <stdlib.h>

static const double turn = 6.283185307179586;

const char *crossing_kind_name(crossing_kind kind) {
    static const char *const names[] = {"figure", "knot", "spheres", "scan", "clean"};
    return names[kind];
}

void crossing_scene_free(crossing_scene *s) {
    for (uint32_t i = 0; i < s->object_count; i++) body_free(&s->objects[i]);
    *s = (crossing_scene){0};
}

/* ---- figure and spheres -------------------------------------------------------------------------------- */

static bool make_figure(uint32_t triangle_count, body *out, io_error *error) {
    deforming_body b;
    if (!deforming_body_make(BODY_FIGURE, triangle_count, DEFORM_LEGS, false, &b, error)) return false;
    double *ends = body_allocate((size_t)2 * b.vertex_count, sizeof(double[3]));
    deforming_body_interval(&b, 4, 0.0, ends, ends + (size_t)b.vertex_count * 3);
    for (uint32_t v = 0; v < b.vertex_count; v++)
        body_add_vertex(out, ends[3 * v], ends[3 * v + 1], ends[3 * v + 2]);
    for (uint32_t t = 0; t < b.triangle_count; t++)
        body_add_triangle(out, b.triangles[3 * t], b.triangles[3 * t + 1], b.triangles[3 * t + 2]);
    free(ends);
    deforming_body_free(&b);
    return true;
}

static bool make_spheres(uint32_t triangle_count, crossing_scene *s, io_error *error) {
    body sphere;
    uint32_t count = body_nearest_count(BODY_SPHERE, triangle_count / CROSSING_OBJECTS_MAX);
    if (!body_make(BODY_SPHERE, count, &sphere, error)) return false;
    for (int i = 0; i < CROSSING_OBJECTS_MAX; i++) {
        double at[3] = {1.83 * (i % 3) + 0.021 * i, 1.87 * (i / 3 % 3), 1.85 * (i / 9) + 0.013 * i};
        body_append(&s->objects[s->object_count++], &sphere, at);
    }
    body_free(&sphere);
    return true;
}

/* ---- tubes --------------------------------------------------------------------------------------------- */

/* Joins rows x columns vertices to a closed surface. */
static void add_grid(body *b, uint32_t rows, uint32_t columns) {
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            uint32_t below = i * columns, above = (i + 1) % rows * columns, next = (j + 1) % columns;
            body_add_triangle(b, below + j, above + j, below + next);
            body_add_triangle(b, above + j, above + next, below + next);
        }
    }
}

/* The torus knot (3, 7), laid flat with a wave. */
static void find_middle(double t, double out[3]) {
    double r = 8.0 + 4.5 * cos(7.0 * t);
    out[0] = r * cos(3.0 * t);
    out[1] = r * sin(3.0 * t);
    out[2] = 0.3 * sin(7.0 * t);
}

static void make_knot(uint32_t triangle_count, body *out) {
    uint32_t columns = (uint32_t)sqrt(triangle_count / 2.0 / 32.0), rows = triangle_count / 2 / columns;
    for (uint32_t i = 0; i < rows; i++) {
        double t = turn * i / rows, p[3], q[3];
        find_middle(t, p);
        find_middle(t + 1e-4, q);
        double x = q[0] - p[0], y = q[1] - p[1], norm = sqrt(x * x + y * y);
        for (uint32_t j = 0; j < columns; j++) {
            double a = turn * j / columns, r = 0.8 + 0.05 * sin(5.0 * a + 60.0 * t);
            body_add_vertex(out, p[0] + r * cos(a) * y / norm, p[1] - r * cos(a) * x / norm,
                            p[2] + r * sin(a));
        }
    }
    add_grid(out, rows, columns);
}

/* A number from -1 to 1. */
static double next_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-52 - 1.0;
}

/* The sides of its squares are about 2 turn / columns. A spike leads one and a half of them outwards, and two along the
 * surface. */
static void make_scan(uint32_t triangle_count, bool spikes, body *out) {
    uint32_t columns = (uint32_t)sqrt(triangle_count / 2.0 / 3.0), rows = triangle_count / 2 / columns;
    uint64_t state = 1;
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            double side = turn / columns, a = turn * i / rows, b = turn * j / columns;
            double noise[3] = {next_random(&state), next_random(&state), next_random(&state)};
            double r = 1.0 + 0.05 * sin(9.0 * a) * cos(7.0 * b) + 0.2 * side * noise[0];
            a += 0.2 * side / 3.0 * noise[1];
            if (spikes && (i * columns + j) % 330 == 250) {
                r += (0.4 + 0.2 * noise[0]) * side;
                a += (2.2 + noise[1]) * side / 3.0;
                b += (2.2 + noise[2]) * side;
            }
            body_add_vertex(out, (3.0 + r * cos(b)) * cos(a), (3.0 + r * cos(b)) * sin(a), r * sin(b));
        }
    }
    add_grid(out, rows, columns);
}

bool crossing_scene_make(crossing_kind kind, uint32_t triangle_count, crossing_scene *out, io_error *error) {
    crossing_scene s = {.name = crossing_kind_name(kind)};
    bool made = true;
    if (kind != CROSSING_SPHERES) s.object_count = 1;
    if (kind == CROSSING_FIGURE) made = make_figure(triangle_count, &s.objects[0], error);
    if (kind == CROSSING_SPHERES) made = make_spheres(triangle_count, &s, error);
    if (kind == CROSSING_KNOT) make_knot(triangle_count, &s.objects[0]);
    if (kind == CROSSING_SCAN || kind == CROSSING_CLEAN)
        make_scan(triangle_count, kind == CROSSING_SCAN, &s.objects[0]);
    *out = s;
    return made;
}
