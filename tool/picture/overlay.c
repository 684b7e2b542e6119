/* Markers, caption and legend, blended over the finished picture. */
#include "tool/picture/shade.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- the bitmap font of captions, and its smooth enlargement --------------------------------------------- */

#define PICTURE_GLYPH_WIDTH  5
#define PICTURE_GLYPH_HEIGHT 8

/* The glyphs from ' ' to '~', four in a line. Each has five columns from the left; the lowest bit is the
 * uppermost dot. */
static const uint8_t glyphs[95][PICTURE_GLYPH_WIDTH] = {
    {0x00, 0x00, 0x00, 0x00, 0x00}, {0x00, 0x00, 0x5f, 0x00, 0x00}, {0x00, 0x07, 0x00, 0x07, 0x00},
    {0x14, 0x7f, 0x14, 0x7f, 0x14}, {0x24, 0x2a, 0x7f, 0x2a, 0x12}, {0x23, 0x13, 0x08, 0x64, 0x62},
    {0x36, 0x49, 0x56, 0x20, 0x50}, {0x00, 0x00, 0x07, 0x00, 0x00}, {0x00, 0x1c, 0x22, 0x41, 0x00},
    {0x00, 0x41, 0x22, 0x1c, 0x00}, {0x14, 0x08, 0x3e, 0x08, 0x14}, {0x08, 0x08, 0x3e, 0x08, 0x08},
    {0x00, 0x80, 0x60, 0x00, 0x00}, {0x08, 0x08, 0x08, 0x08, 0x08}, {0x00, 0x60, 0x60, 0x00, 0x00},
    {0x20, 0x10, 0x08, 0x04, 0x02}, {0x3e, 0x51, 0x49, 0x45, 0x3e}, {0x00, 0x42, 0x7f, 0x40, 0x00},
    {0x42, 0x61, 0x51, 0x49, 0x46}, {0x21, 0x41, 0x45, 0x4b, 0x31}, {0x18, 0x14, 0x12, 0x7f, 0x10},
    {0x27, 0x45, 0x45, 0x45, 0x39}, {0x3c, 0x4a, 0x49, 0x49, 0x30}, {0x01, 0x71, 0x09, 0x05, 0x03},
    {0x36, 0x49, 0x49, 0x49, 0x36}, {0x06, 0x49, 0x49, 0x29, 0x1e}, {0x00, 0x36, 0x36, 0x00, 0x00},
    {0x00, 0x80, 0x76, 0x06, 0x00}, {0x08, 0x14, 0x22, 0x41, 0x00}, {0x14, 0x14, 0x14, 0x14, 0x14},
    {0x00, 0x41, 0x22, 0x14, 0x08}, {0x02, 0x01, 0x51, 0x09, 0x06}, {0x3e, 0x41, 0x5d, 0x55, 0x1e},
    {0x7e, 0x11, 0x11, 0x11, 0x7e}, {0x7f, 0x49, 0x49, 0x49, 0x36}, {0x3e, 0x41, 0x41, 0x41, 0x22},
    {0x7f, 0x41, 0x41, 0x41, 0x3e}, {0x7f, 0x49, 0x49, 0x49, 0x41}, {0x7f, 0x09, 0x09, 0x09, 0x01},
    {0x3e, 0x41, 0x49, 0x49, 0x3a}, {0x7f, 0x08, 0x08, 0x08, 0x7f}, {0x00, 0x41, 0x7f, 0x41, 0x00},
    {0x20, 0x40, 0x41, 0x3f, 0x01}, {0x7f, 0x08, 0x14, 0x22, 0x41}, {0x7f, 0x40, 0x40, 0x40, 0x40},
    {0x7f, 0x02, 0x0c, 0x02, 0x7f}, {0x7f, 0x04, 0x08, 0x10, 0x7f}, {0x3e, 0x41, 0x41, 0x41, 0x3e},
    {0x7f, 0x09, 0x09, 0x09, 0x06}, {0x3e, 0x41, 0x51, 0x21, 0x5e}, {0x7f, 0x09, 0x19, 0x29, 0x46},
    {0x46, 0x49, 0x49, 0x49, 0x31}, {0x01, 0x01, 0x7f, 0x01, 0x01}, {0x3f, 0x40, 0x40, 0x40, 0x3f},
    {0x1f, 0x20, 0x40, 0x20, 0x1f}, {0x3f, 0x40, 0x38, 0x40, 0x3f}, {0x63, 0x14, 0x08, 0x14, 0x63},
    {0x07, 0x08, 0x70, 0x08, 0x07}, {0x61, 0x51, 0x49, 0x45, 0x43}, {0x00, 0x7f, 0x41, 0x41, 0x00},
    {0x02, 0x04, 0x08, 0x10, 0x20}, {0x00, 0x41, 0x41, 0x7f, 0x00}, {0x04, 0x02, 0x01, 0x02, 0x04},
    {0x80, 0x80, 0x80, 0x80, 0x80}, {0x00, 0x01, 0x02, 0x04, 0x00}, {0x20, 0x54, 0x54, 0x54, 0x78},
    {0x7f, 0x48, 0x44, 0x44, 0x38}, {0x38, 0x44, 0x44, 0x44, 0x28}, {0x38, 0x44, 0x44, 0x48, 0x7f},
    {0x38, 0x54, 0x54, 0x54, 0x18}, {0x08, 0x7e, 0x09, 0x01, 0x02}, {0x18, 0xa4, 0xa4, 0xa4, 0x7c},
    {0x7f, 0x08, 0x04, 0x04, 0x78}, {0x00, 0x44, 0x7d, 0x40, 0x00}, {0x40, 0x80, 0x84, 0x7d, 0x00},
    {0x7f, 0x10, 0x28, 0x44, 0x00}, {0x00, 0x41, 0x7f, 0x40, 0x00}, {0x7c, 0x04, 0x18, 0x04, 0x78},
    {0x7c, 0x08, 0x04, 0x04, 0x78}, {0x38, 0x44, 0x44, 0x44, 0x38}, {0xfc, 0x44, 0x44, 0x44, 0x38},
    {0x38, 0x44, 0x44, 0x44, 0xfc}, {0x7c, 0x08, 0x04, 0x04, 0x08}, {0x48, 0x54, 0x54, 0x54, 0x20},
    {0x04, 0x3f, 0x44, 0x40, 0x20}, {0x3c, 0x40, 0x40, 0x20, 0x7c}, {0x1c, 0x20, 0x40, 0x20, 0x1c},
    {0x3c, 0x40, 0x30, 0x40, 0x3c}, {0x44, 0x28, 0x10, 0x28, 0x44}, {0x1c, 0xa0, 0xa0, 0xa0, 0x7c},
    {0x44, 0x64, 0x54, 0x4c, 0x44}, {0x00, 0x08, 0x36, 0x41, 0x00}, {0x00, 0x00, 0x7f, 0x00, 0x00},
    {0x00, 0x41, 0x36, 0x08, 0x00}, {0x08, 0x04, 0x08, 0x10, 0x08},
};

static double dot_at(const uint8_t *glyph, int column, int row) {
    bool inside = column >= 0 && column < PICTURE_GLYPH_WIDTH && row >= 0 && row < PICTURE_GLYPH_HEIGHT;
    return inside ? glyph[column] >> row & 1 : 0.0;
}

/* Bilinear between the dots' middles, cut where it falls below a little less than half (so that diagonals
 * hold together), the cut spread over one pixel. */
/* The share (0..1) that the glyph covers of a pixel at (x, y) in dots from its upper left corner, for `scale`
 * pixels a dot: corners are rounded and rims smoothed as the scale grows. */
static double picture_glyph_coverage(char character, double x, double y, double scale) {
    bool printable = character >= ' ' && character <= '~';
    const uint8_t *glyph = glyphs[(printable ? character : '?') - ' '];
    double column = floor(x - 0.5), row = floor(y - 0.5);
    double u = x - 0.5 - column, v = y - 0.5 - row;
    int c = (int)column, r = (int)row;
    double value = (dot_at(glyph, c, r) * (1.0 - u) + dot_at(glyph, c + 1, r) * u) * (1.0 - v) +
                   (dot_at(glyph, c, r + 1) * (1.0 - u) + dot_at(glyph, c + 1, r + 1) * u) * v;
    return fmin(fmax((value - 0.42) * scale + 0.5, 0.0), 1.0);
}

static const uint8_t ink[3] = {32, 36, 44}, paper[3] = {255, 255, 255};

/* Coverage of the pixel at `distance` from the centre by a disc, its rim smoothed over one pixel. */
static double disc_coverage(double distance, double radius) {
    return fmin(fmax(radius + 0.5 - distance, 0.0), 1.0);
}

/* A disc of the colour with a dark outline and a thin white halo, which sets it off from any surface. The
 * layers are mixed first, so that a half transparent disc shows the surface and not its own outline. */
static void draw_disc(picture_image *image, double x, double y, double radius, const uint8_t colour[3],
                      double opacity) {
    double outline = fmin(fmax(0.22 * radius, 1.0), 2.0), reach = radius + 2.5;
    if (!(x > -reach && y > -reach && x < image->width + reach && y < image->height + reach)) return;
    for (int64_t row = (int64_t)floor(y - reach); row <= (int64_t)(y + reach); row++)
        for (int64_t column = (int64_t)floor(x - reach); column <= (int64_t)(x + reach); column++) {
            double distance = hypot((double)column + 0.5 - x, (double)row + 0.5 - y);
            double inked = disc_coverage(distance, radius),
                   filled = disc_coverage(distance, radius - outline);
            double halo = 0.7 * disc_coverage(distance, radius + 1.2);
            uint8_t mixed[3];
            for (int i = 0; i < 3; i++)
                mixed[i] = (uint8_t)((1.0 - filled) * ((1.0 - inked) * paper[i] + inked * ink[i]) +
                                     filled * colour[i] + 0.5);
            picture_image_blend(image, column, row, mixed, opacity * fmax(halo, inked));
        }
}

typedef struct placed_marker {
    double x, y, depth;
    size_t index;
} placed_marker;

static int far_first(const void *left, const void *right) {
    const placed_marker *a = left, *b = right;
    if (a->depth != b->depth) return a->depth > b->depth ? -1 : 1;
    return a->index < b->index ? -1 : a->index > b->index;
}

static bool marker_hidden(const picture_visibility *visibility, const placed_marker *marker,
                          double ball_radius) {
    double x = floor(marker->x * visibility->samples), y = floor(marker->y * visibility->samples);
    uint32_t columns = visibility->width * visibility->samples,
             rows = visibility->height * visibility->samples;
    if (!(x >= 0.0 && y >= 0.0 && x < columns && y < rows)) return false;
    double inverse_depth = visibility->inverse_depth[(size_t)y * columns + (size_t)x];
    return (marker->depth - ball_radius) * inverse_depth > 1.0;
}

bool picture_draw_markers(picture_image *image, const picture_visibility *visibility,
                          const picture_camera *camera, const picture_marker *markers, size_t count,
                          io_error *error) {
    if (count == 0) return true;
    placed_marker *placed = count < SIZE_MAX / sizeof *placed ? malloc(count * sizeof *placed) : NULL;
    if (placed == NULL) return io_fail(error, "picture with %zu markers: out of memory", count);
    size_t placed_count = 0;
    for (size_t i = 0; i < count; i++) {
        double at[3];
        picture_camera_project(camera, markers[i].position, at);
        if (at[2] < camera->near_depth) continue;
        placed[placed_count++] = (placed_marker){at[0] / at[2], at[1] / at[2], at[2], i};
    }
    qsort(placed, placed_count, sizeof *placed, far_first);
    for (size_t i = 0; i < placed_count; i++) {
        const picture_marker *marker = &markers[placed[i].index];
        double radius = fmin(fmax(marker->radius_pixels, 0.5), image->width);
        double ball_radius = radius * placed[i].depth / camera->focal;
        double opacity =
            marker->colour[3] / 255.0 * (marker_hidden(visibility, &placed[i], ball_radius) ? 0.5 : 1.0);
        draw_disc(image, placed[i].x, placed[i].y, radius, marker->colour, opacity);
    }
    free(placed);
    return true;
}

static void draw_text(picture_image *image, double left, double top, double scale, const char *text) {
    int64_t height = (int64_t)ceil(scale * PICTURE_GLYPH_HEIGHT),
            width = (int64_t)ceil(scale * PICTURE_GLYPH_WIDTH);
    for (; *text != '\0' && left < image->width; text++, left += scale * (PICTURE_GLYPH_WIDTH + 1))
        for (int64_t row = 0; row < height; row++)
            for (int64_t column = 0; column < width; column++)
                picture_image_blend(image, (int64_t)left + column, (int64_t)top + row, ink,
                                    picture_glyph_coverage(*text, ((double)column + 0.5) / scale,
                                                           ((double)row + 0.5) / scale, scale));
}

static void draw_panel(picture_image *image, double left, double top, double right, double bottom) {
    for (int64_t row = (int64_t)top; row < (int64_t)bottom && row < image->height; row++)
        for (int64_t column = (int64_t)left; column < (int64_t)right && column < image->width; column++)
            picture_image_blend(image, column, row, paper, 0.8);
}

static double text_scale(uint32_t width, uint32_t height, double enlarged) {
    return enlarged * fmax(1.0, 0.5 * ceil(fmin(width, height) / 200.0));
}

void picture_caption_size(uint32_t width, uint32_t height, double enlarged, const char *caption,
                          const picture_legend *legend, size_t count, double size[2]) {
    double scale = text_scale(width, height, enlarged);
    size_t longest = caption != NULL ? strlen(caption) : 0, lines = count + (caption != NULL);
    for (size_t i = 0; i < count; i++) {
        size_t length = strlen(legend[i].text) + 2;
        if (length > longest) longest = length;
    }
    size[0] = lines > 0 ? scale * (11.0 + (double)longest * (PICTURE_GLYPH_WIDTH + 1)) : 0.0;
    size[1] = lines > 0 ? scale * (9.0 + 12.0 * (double)lines) : 0.0;
}

void picture_draw_caption(picture_image *image, double enlarged, const char *caption,
                          const picture_legend *legend, size_t count) {
    if ((caption == NULL && count == 0) || enlarged == 0.0) return;
    double scale = text_scale(image->width, image->height, enlarged), line = scale * 12.0;
    double left = scale * 8.0, top = scale * 8.0, size[2];
    picture_caption_size(image->width, image->height, enlarged, caption, legend, count, size);
    draw_panel(image, 0.5 * left, 0.5 * top, size[0], size[1]);
    if (caption != NULL) draw_text(image, left, top, scale, caption);
    if (caption != NULL) top += line;
    for (size_t i = 0; i < count && top < image->height; i++, top += line) {
        draw_disc(image, left + 3.5 * scale, top + 3.5 * scale, 3.5 * scale, legend[i].colour, 1.0);
        draw_text(image, left + 2.0 * scale * (PICTURE_GLYPH_WIDTH + 1), top, scale, legend[i].text);
    }
}
