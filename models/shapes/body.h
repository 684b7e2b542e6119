/* Triangle meshes that grow. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Grows from {0}; body_free releases it. When memory runs out, the program ends with a message. */
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

/* Returns the enclosed volume, which is positive when the triangles are counter-clockwise from outside. */
double body_volume(const body *b);

/* Returns the least angle of all triangles in degrees, or 0 when one has no area. */
double body_least_angle(const body *b);

/* Allocates zeroed memory, to be freed; never returns NULL. */
void *body_allocate(size_t count, size_t size);
