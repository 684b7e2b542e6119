/* Scenes of any size that are made here: bodies that deform from frame to frame by about one edge length, with and
 * without contact; and surfaces that pass through each other, at one moment. */
#include "benchmarks/lib/made_scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_LENGTH = 4096 };

static const double turn = 6.283185307179586;

/* ---- making ------------------------------------------------------------------------------------------ */

static void find_extent(deforming_body *b) {
    double extent = 0.0;
    b->length = 1.0;
    for (int k = 0; k < 3; k++) b->low[k] = b->high[k] = b->rest[k];
    for (size_t i = 0; i < (size_t)b->vertex_count * 3; i++) {
        b->low[i % 3] = fmin(b->low[i % 3], b->rest[i]);
        b->high[i % 3] = fmax(b->high[i % 3], b->rest[i]);
    }
    for (int k = 0; k < 3; k++) extent = fmax(extent, b->high[k] - b->low[k]);
    while (b->length > extent) b->length *= 0.5;
    while (2.0 * b->length <= extent) b->length *= 2.0;
}

static void find_edge(deforming_body *b) {
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)b->triangle_count * 3; i++) {
        const double *p = b->rest + (size_t)b->triangles[i] * 3;
        const double *q = b->rest + (size_t)b->triangles[i % 3 == 2 ? i - 2 : i + 1] * 3;
        sum += sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                    (p[2] - q[2]) * (p[2] - q[2]));
    }
    b->edge = sum / (3.0 * b->triangle_count);
}

/* Returns a permutation of 0 .. count - 1, the same every time. */
static uint32_t *random_order(uint32_t count) {
    uint32_t *order = body_allocate(count, sizeof *order);
    uint64_t state = 1;
    for (uint32_t i = 0; i < count; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        uint32_t j = (uint32_t)((state >> 33) % (i + 1));
        order[i] = order[j];
        order[j] = i;
    }
    return order;
}

static void shuffle_body(deforming_body *b) {
    uint32_t *vertices = random_order(b->vertex_count), *triangles = random_order(b->triangle_count);
    double *rest = body_allocate(b->vertex_count, sizeof(double[3]));
    uint32_t *corners = body_allocate(b->triangle_count, sizeof(uint32_t[3]));
    for (size_t v = 0; v < b->vertex_count; v++)
        memcpy(rest + (size_t)vertices[v] * 3, b->rest + v * 3, sizeof(double[3]));
    for (size_t i = 0; i < (size_t)b->triangle_count * 3; i++)
        corners[(size_t)triangles[i / 3] * 3 + i % 3] = vertices[b->triangles[i]];
    free(vertices);
    free(triangles);
    free(b->rest);
    free(b->triangles);
    b->rest = rest;
    b->triangles = corners;
}

bool deforming_body_make(body_kind kind, uint32_t triangle_count, deformation motion, bool shuffled,
                         deforming_body *out, io_error *error) {
    body shape;
    if (!body_make(kind, body_nearest_count(kind, triangle_count), &shape, error)) return false;
    deforming_body b = {.vertex_count = shape.vertex_count,
                        .triangle_count = shape.triangle_count,
                        .triangles = shape.triangles,
                        .rest = shape.positions,
                        .motion = motion};
    if (shuffled) shuffle_body(&b);
    find_extent(&b);
    find_edge(&b);
    *out = b;
    return true;
}

bool deforming_body_read(const char *folder, const char *name, int first, deforming_body *out,
                         io_error *error) {
    char paths[2][PATH_LENGTH];
    mesh_file a, z;
    for (int i = 0; i < 2; i++) snprintf(paths[i], PATH_LENGTH, "%s/%s%d.ply", folder, name, first + i);
    if (!mesh_file_read(paths[0], &a, error)) return false;
    if (!mesh_file_read(paths[1], &z, error)) {
        mesh_file_free(&a);
        return false;
    }
    bool same = a.vertex_count == z.vertex_count && a.triangle_count == z.triangle_count &&
                memcmp(a.triangles, z.triangles, a.triangle_count * sizeof(uint32_t[3])) == 0;
    if (!same) {
        mesh_file_free(&a);
        mesh_file_free(&z);
        return io_fail(error, "%s and %s: their triangles are not the same", paths[0], paths[1]);
    }
    deforming_body b = {.vertex_count = a.vertex_count,
                        .triangle_count = a.triangle_count,
                        .triangles = a.triangles,
                        .rest = a.positions,
                        .last = z.positions,
                        .motion = DEFORM_PAIR};
    free(z.triangles);
    find_extent(&b);
    find_edge(&b);
    *out = b;
    return true;
}

void deforming_body_free(deforming_body *b) {
    free(b->triangles);
    free(b->rest);
    free(b->last);
    *b = (deforming_body){0};
}

/* ---- motion ------------------------------------------------------------------------------------------ */

/* Moves x by a function of y and z, y by one of z, and z increasingly by one of itself. This is a
 * triangular map, and so is the linear motion between two such maps. Triangular maps are one-to-one, so a
 * surface that did not touch itself at rest never does; nor does a fine enough mesh. */
static void apply_wave(const deforming_body *b, double phase, double p[3]) {
    double size = 0.08 * b->length, height = b->high[2] - b->low[2];
    double up = (p[2] - b->low[2]) / height, across = (p[1] - b->low[1]) / height;
    p[0] += size * sin(turn * (up + 0.3 * across) + phase);
    p[1] += size * (sin(turn * 0.7 * up + phase) + up * up * cos(phase));
    p[2] += (p[2] - b->low[2]) * 0.03 * sin(phase);
}

/* Moves the legs of the figure, below its thighs, towards and past each other: nothing is at x = 0 there. */
static void close_legs(double distance, double p[3]) {
    double down = fmin(fmax((0.7 - p[2]) / 0.4, 0.0), 1.0);
    p[0] -= down * down * (3.0 - 2.0 * down) * distance * p[0] / sqrt(p[0] * p[0] + 0.0025);
}

static void place_frame(const deforming_body *b, uint32_t frame, double shift, double *out) {
    const double *from = b->motion == DEFORM_PAIR && frame > 0 ? b->last : b->rest;
    double phase = b->edge / (0.08 * b->length) * frame, distance = 0.13 + 0.5 * b->edge * frame;
    for (size_t v = 0; v < b->vertex_count; v++) {
        double p[3] = {from[3 * v], from[3 * v + 1], from[3 * v + 2]};
        if (b->motion == DEFORM_WAVE) apply_wave(b, phase, p);
        if (b->motion == DEFORM_LEGS) close_legs(distance, p);
        for (int k = 0; k < 3; k++)
            out[3 * v + (size_t)k] = nearbyint(p[k] * 0x1p30) * 0x1p-30 + (k == 0 ? shift : 0.0);
    }
}

void deforming_body_interval(const deforming_body *b, uint32_t i, double shift, double *start, double *end) {
    uint32_t first = b->motion == DEFORM_PAIR ? 0 : i;
    place_frame(b, first, i * shift, start);
    place_frame(b, first + 1, (i + 1) * shift, end);
}

double deforming_body_speed(const deforming_body *b) {
    size_t count = (size_t)b->vertex_count * 3;
    double *ends = body_allocate(2 * count, sizeof *ends), sum = 0.0;
    deforming_body_interval(b, 1, 0.0, ends, ends + count);
    for (size_t i = 0; i < count; i++) sum += (ends[count + i] - ends[i]) * (ends[count + i] - ends[i]);
    free(ends);
    return sqrt(sum / b->vertex_count) / b->edge;
}

/* ---- surfaces that cross ------------------------------------------------------------------------------- */

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
