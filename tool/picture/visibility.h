/* The z-buffer: which triangle is seen at each sample, and how near. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

#define PICTURE_NO_TRIANGLE UINT32_MAX
#define PICTURE_SAMPLES_MAX 4u

/* samples x samples samples a pixel, rows of samples from the top. Sample (i, j) lies at pixel coordinates
 * ((i + 1/2) / samples, (j + 1/2) / samples). */
typedef struct picture_visibility {
    uint32_t width, height, samples; /* width and height in pixels */
    float *inverse_depth;            /* 1 / depth, 0 where nothing is seen */
    uint32_t *triangle;              /* PICTURE_NO_TRIANGLE where nothing is seen */
} picture_visibility;

/* A triangle's three edge functions over the picture: edge[k] . (x, y, 1) is proportional to the barycentric
 * coordinate of corner k on the surface itself (perspective is accounted for) and >= 0 inside. */
typedef struct picture_edges {
    double edge[3][3];
    double volume; /* > 0; the sum of the edge functions over it is 1 / depth */
    bool front;    /* the triangle's counter-clockwise side is seen */
} picture_edges;

/* Corners in homogeneous pixel coordinates; any of them may lie behind the eye. False for a triangle that is
 * seen exactly edge-on. */
bool picture_edges_set(const double *projected, const uint32_t corners[3], picture_edges *out);

/* Creates a buffer in which nothing is seen yet. On false *out is untouched. */
bool picture_visibility_create(uint32_t width, uint32_t height, uint32_t samples, picture_visibility *out,
                               io_error *error);
void picture_visibility_free(picture_visibility *visibility);

/* Draws triangles, the first of which is known as `first_number`; at equal depth the one drawn first
 * stays. */
void picture_visibility_draw(picture_visibility *visibility, const double *projected,
                             const uint32_t *triangles, uint32_t triangle_count, uint32_t first_number,
                             double near_depth);
