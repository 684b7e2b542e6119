/* Bodies of any size that deform from frame to frame by about one edge length, with and without contact. */
#include "benchmarks/lib/deforming_body.h"

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
