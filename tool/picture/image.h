/* An RGBA picture in memory and its PNG file. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

/* No side may be longer: keeps every size computation far from overflow. */
#define PICTURE_SIDE_MAX 16384u

/* Rows from the top, pixels from the left, four bytes each: red, green, blue and straight (not premultiplied)
 * alpha, the colours in sRGB. */
typedef struct picture_image {
    uint32_t width, height;
    uint8_t *pixels;
} picture_image;

/* A fully transparent picture. On false *out is untouched. */
bool picture_image_create(uint32_t width, uint32_t height, picture_image *out, io_error *error);

/* Frees what create allocated and zeroes the struct; a zeroed struct is fine. */
void picture_image_free(picture_image *image);

/* Lays `colour` with weight `coverage` (0..1) over the pixel; outside the picture nothing happens. */
void picture_image_blend(picture_image *image, int64_t x, int64_t y, const uint8_t colour[3],
                         double coverage);

/* On false *error names the file and the reason, and no half-written file is left. */
bool picture_image_write_png(const char *path, const picture_image *image, io_error *error);
