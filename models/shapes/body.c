/* Triangle meshes that grow. */
#include "models/shapes/body.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *check_memory(void *block) {
    if (block != NULL) return block;
    fprintf(stderr, "out of memory for the mesh\n");
    exit(1);
}

void *body_allocate(size_t count, size_t size) {
    return check_memory(calloc(count > 0 ? count : 1, size));
}

static void *grow_block(void *block, uint32_t *capacity, size_t item_size) {
    *capacity = *capacity == 0 ? 1024 : *capacity * 2;
    return check_memory(realloc(block, *capacity * item_size));
}

uint32_t body_add_vertex(body *b, double x, double y, double z) {
    if (b->vertex_count == b->vertex_capacity)
        b->positions = grow_block(b->positions, &b->vertex_capacity, 3 * sizeof *b->positions);
    memcpy(b->positions + (size_t)b->vertex_count * 3, (double[3]){x, y, z}, 3 * sizeof(double));
    return b->vertex_count++;
}

void body_add_triangle(body *b, uint32_t v0, uint32_t v1, uint32_t v2) {
    if (b->triangle_count == b->triangle_capacity)
        b->triangles = grow_block(b->triangles, &b->triangle_capacity, 3 * sizeof *b->triangles);
    memcpy(b->triangles + (size_t)b->triangle_count++ * 3, (uint32_t[3]){v0, v1, v2}, 3 * sizeof(uint32_t));
}

void body_free(body *b) {
    free(b->positions);
    free(b->triangles);
    *b = (body){0};
}

void body_append(body *b, const body *other, const double offset[3]) {
    uint32_t first = b->vertex_count;
    for (uint32_t v = 0; v < other->vertex_count; v++) {
        const double *p = other->positions + (size_t)v * 3;
        body_add_vertex(b, p[0] + offset[0], p[1] + offset[1], p[2] + offset[2]);
    }
    for (uint32_t t = 0; t < other->triangle_count; t++) {
        const uint32_t *v = other->triangles + (size_t)t * 3;
        body_add_triangle(b, first + v[0], first + v[1], first + v[2]);
    }
}

/* Rounds through memory: gcc 12 may drop the rounding of neighbouring stores when it vectorises them. */
static double rounded_to_float(double x) {
    volatile float rounded = (float)x;
    return rounded;
}

void body_round(body *b) {
    for (size_t i = 0; i < (size_t)b->vertex_count * 3; i++)
        b->positions[i] = rounded_to_float(b->positions[i]);
}

double body_volume(const body *b) {
    double six = 0.0;
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t *v = b->triangles + (size_t)t * 3;
        const double *p = b->positions + (size_t)v[0] * 3, *q = b->positions + (size_t)v[1] * 3,
                     *r = b->positions + (size_t)v[2] * 3;
        six += p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
               p[2] * (q[0] * r[1] - q[1] * r[0]);
    }
    return six / 6.0;
}

/* Returns the angle at corner k in degrees. */
static double corner_angle(const body *b, const uint32_t v[3], uint32_t k) {
    const double *p = b->positions + (size_t)v[k] * 3, *q = b->positions + (size_t)v[(k + 1) % 3] * 3,
                 *r = b->positions + (size_t)v[(k + 2) % 3] * 3;
    double dot = 0.0, qq = 0.0, rr = 0.0;
    for (int i = 0; i < 3; i++) {
        dot += (q[i] - p[i]) * (r[i] - p[i]);
        qq += (q[i] - p[i]) * (q[i] - p[i]);
        rr += (r[i] - p[i]) * (r[i] - p[i]);
    }
    if (qq == 0.0 || rr == 0.0) return 0.0;
    return acos(fmin(fmax(dot / sqrt(qq * rr), -1.0), 1.0)) * 180.0 / 3.14159265358979323846;
}

double body_least_angle(const body *b) {
    double least = 180.0;
    for (uint32_t t = 0; t < b->triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++)
            least = fmin(least, corner_angle(b, b->triangles + (size_t)t * 3, k));
    return least;
}
