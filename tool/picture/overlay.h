/* Markers, caption and legend, which are drawn over the surface. */
#pragma once

#include "tool/picture/camera.h"
#include "tool/picture/image.h"
#include "tool/picture/visibility.h"

#include <stddef.h>

/* A filled disc with an outline around a point; half transparent where the surface hides the point. */
typedef struct picture_marker {
    double position[3];
    float radius_pixels;
    uint8_t colour[4]; /* red, green, blue, alpha */
} picture_marker;

/* A coloured dot and what it stands for. */
typedef struct picture_legend {
    uint8_t colour[3];
    const char *text;
} picture_legend;

/* Draws from far to near. A marker counts as a ball of its radius: it is hidden when all of it lies behind
 * the surface. False when out of memory. */
bool picture_draw_markers(picture_image *image, const picture_visibility *visibility,
                          const picture_camera *camera, const picture_marker *markers, size_t count,
                          io_error *error);

/* How far picture_draw_caption, with the same arguments, reaches from the upper left corner, in pixels. */
void picture_caption_size(uint32_t width, uint32_t height, double enlarged, const char *caption,
                          const picture_legend *legend, size_t count, double size[2]);

/* Draws caption and legend in the upper left corner, `enlarged` times the usual size; caption may be NULL.
 * Texts are printable ASCII; any other byte becomes '?'. */
void picture_draw_caption(picture_image *image, double enlarged, const char *caption,
                          const picture_legend *legend, size_t count);
