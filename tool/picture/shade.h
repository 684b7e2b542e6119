/* Turns the z-buffer into pixels: colours, lights and wires. */
#pragma once

#include "tool/picture/camera.h"
#include "tool/picture/image.h"
#include "tool/picture/shadow.h"
#include "tool/picture/visibility.h"

/* Smooth: normals are interpolated, except across creases. Unlit: the colours exactly as given. */
typedef enum picture_shading { PICTURE_SMOOTH, PICTURE_FLAT, PICTURE_UNLIT } picture_shading;

typedef struct picture_surface {
    const double *projected;   /* homogeneous pixel coordinates, 3 per vertex */
    const float *normals;      /* unit, outward, in camera space, 3 per vertex; NULL unless smooth */
    const uint32_t *triangles; /* 3 per triangle */
    uint32_t triangle_count;
    const uint8_t *triangle_colours; /* RGB per triangle, or NULL */
    const uint8_t *vertex_colours;   /* RGB per vertex, or NULL; triangle_colours go first */
    picture_shading shading;
    bool wire;
    const picture_ground *ground; /* of scenery; else NULL */
} picture_surface;

/* Angle-weighted vertex normals in camera space, for picture_surface.normals. */
void picture_vertex_normals(const picture_camera *camera, const double *positions, uint32_t vertex_count,
                            const uint32_t *triangles, uint32_t triangle_count, float *out);

/* Fills the whole picture, which has the visibility's size. The visibility numbers the triangles of all
 * surfaces one after the other. */
void picture_shade(const picture_visibility *visibility, const picture_surface *surfaces,
                   const picture_camera *camera, bool transparent, picture_image *image);
