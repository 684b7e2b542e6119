/* Triangle meshes that grow. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Grows from {0}; body_free takes it back. Where memory runs out, the program ends with a message. */
typedef struct body {
    uint32_t vertex_count, triangle_count;
    uint32_t vertex_capacity, triangle_capacity;
    double *positions;   /* vertex_count * 3 */
    uint32_t *triangles; /* triangle_count * 3, counter-clockwise from outside */
} body;

void body_free(body *b);

uint32_t body_add_vertex(body *b, double x, double y, double z);
void body_add_triangle(body *b, uint32_t v0, uint32_t v1, uint32_t v2);

/* Adds a copy of the triangles and vertices of another body, moved. */
void body_append(body *b, const body *other, const double offset[3]);

/* Rounds all positions to single precision, so that files of that precision hold the same numbers. */
void body_round(body *b);

/* Enclosed by the triangles: positive where they are counter-clockwise from outside. */
double body_volume(const body *b);

/* Of the whole surface, in degrees; 0 with triangles without area. */
double body_least_angle(const body *b);

/* Zeroed, never NULL; to be freed. */
void *body_allocate(size_t count, size_t size);
