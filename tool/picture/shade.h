/* The steps of a rendering: the z-buffer, the ground with the shadow of a body, the pixels of surfaces, and
 * markers, caption and legend. */
#pragma once

#include "tool/io/io.h"
#include "tool/picture/picture.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- the z-buffer: which triangle is seen at each sample, and how near --------------------------------- */

#define PICTURE_NO_TRIANGLE UINT32_MAX

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

/* ---- the ground ---------------------------------------------------------------------------------------- */

enum { PICTURE_SHADOW_TAPS = 160 };

/* A point of the disc around a shaded point in which the body is looked for; lengths in cells. */
typedef struct picture_shadow_tap {
    double offset[2], radius, area;
} picture_shadow_tap;

/* The body's least and greatest height over each cell of a level grid, as shares of its extent. */
typedef struct picture_shadow {
    uint32_t columns, rows;
    int across, along, up; /* axes */
    double origin[3];      /* of cell (0, 0), and the height 0 */
    double cell, extent;   /* of a cell, and the greatest of the body */
    float *low, *high;     /* low > high where there is no body */
    picture_shadow_tap taps[PICTURE_SHADOW_TAPS];
} picture_shadow;

/* On false *out is untouched. A body without extent casts no shadow. */
bool picture_shadow_create(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                           uint32_t triangle_count, bool y_up, picture_shadow *out, io_error *error);
void picture_shadow_free(picture_shadow *shadow);

/* The light from above that the body takes from a level surface at the point, 0 to 1: sharp and dark where
 * they are near, wider and fainter the farther the body is above. */
double picture_shadow_at(const picture_shadow *shadow, const double point[3]);

typedef struct picture_ground {
    double square; /* side of the squares; 0: none */
    bool y_up;     /* else z is up */
    const picture_shadow *shadow;
} picture_ground;

/* The share of the light that is left at pixel (x, y) in the given depth; normal and view (towards the eye)
 * are unit vectors in camera space. */
double picture_ground_light(const picture_ground *ground, const picture_camera *camera,
                            const double normal[3], const double view[3], double x, double y, double depth);

/* ---- surfaces ------------------------------------------------------------------------------------------ */

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

/* ---- markers, caption and legend ----------------------------------------------------------------------- */

/* Draws from far to near. A marker counts as a ball of its radius: it is hidden when all of it lies behind
 * the surface. False when out of memory. */
bool picture_draw_markers(picture_image *image, const picture_visibility *visibility,
                          const picture_camera *camera, const picture_marker *markers, size_t count,
                          io_error *error);

/* The distances that picture_draw_caption, with the same arguments, reaches from the upper left corner, in
 * pixels. */
void picture_caption_size(uint32_t width, uint32_t height, double enlarged, const char *caption,
                          const picture_legend *legend, size_t count, double size[2]);

/* Draws caption and legend in the upper left corner, `enlarged` times the usual size; caption may be NULL.
 * Texts are printable ASCII; any other byte becomes '?'. */
void picture_draw_caption(picture_image *image, double enlarged, const char *caption,
                          const picture_legend *legend, size_t count);
