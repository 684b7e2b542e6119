/* RGBA pictures: memory, blending and the way into a PNG file. */
#include "tool/picture/picture.h"

#include "tool/io/output_file.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool picture_image_create(uint32_t width, uint32_t height, picture_image *out, io_error *error) {
    if (width == 0 || height == 0 || width > PICTURE_SIDE_MAX || height > PICTURE_SIDE_MAX)
        return io_fail(error, "picture of %u x %u pixels: each side must be 1 to %u", (unsigned)width,
                       (unsigned)height, PICTURE_SIDE_MAX);
    uint8_t *pixels = calloc((size_t)width * height, 4);
    if (pixels == NULL)
        return io_fail(error, "picture of %u x %u pixels: out of memory", (unsigned)width, (unsigned)height);
    *out = (picture_image){.width = width, .height = height, .pixels = pixels};
    return true;
}

void picture_image_free(picture_image *image) {
    free(image->pixels);
    *image = (picture_image){0};
}

void picture_image_blend(picture_image *image, int64_t x, int64_t y, const uint8_t colour[3],
                         double coverage) {
    if (x < 0 || y < 0 || x >= image->width || y >= image->height || !(coverage > 0.0)) return;
    uint8_t *pixel = image->pixels + 4 * ((size_t)y * image->width + (size_t)x);
    double over = coverage < 1.0 ? coverage : 1.0;
    double under = pixel[3] / 255.0 * (1.0 - over);
    for (int i = 0; i < 3; i++)
        pixel[i] = (uint8_t)((colour[i] * over + pixel[i] * under) / (over + under) + 0.5);
    pixel[3] = (uint8_t)(255.0 * (over + under) + 0.5);
}

/* The encoded file grows in memory: libpng can then fail without any file having been touched. */
typedef struct encoded_png {
    uint8_t *bytes;
    size_t size, capacity;
    char reason[256];
} encoded_png;

static void append_bytes(png_structp png, png_bytep data, png_size_t size) {
    encoded_png *encoded = png_get_io_ptr(png);
    if (size > encoded->capacity - encoded->size) {
        size_t capacity = 2 * encoded->capacity + size + 4096;
        uint8_t *bytes = realloc(encoded->bytes, capacity);
        if (bytes == NULL) png_error(png, "out of memory");
        encoded->bytes = bytes;
        encoded->capacity = capacity;
    }
    memcpy(encoded->bytes + encoded->size, data, size);
    encoded->size += size;
}

static void flush_nothing(png_structp png) {
    (void)png;
}

static void keep_reason(png_structp png, png_const_charp message) {
    encoded_png *encoded = png_get_error_ptr(png);
    snprintf(encoded->reason, sizeof encoded->reason, "%s", message);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

/* Runs under the setjmp of encode_png and owns nothing, so a longjmp out of it loses nothing. */
static void write_chunks(png_structp png, png_infop info, const picture_image *image) {
    png_set_IHDR(png, info, image->width, image->height, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    /* Rendered pictures are smooth: one good filter at a fast level is near the best size at a third of the
     * time. */
    png_set_compression_level(png, 4);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    png_write_info(png, info);
    for (uint32_t y = 0; y < image->height; y++)
        png_write_row(png, image->pixels + (size_t)y * image->width * 4);
    png_write_end(png, info);
}

static bool encode_png(const picture_image *image, encoded_png *encoded) {
    snprintf(encoded->reason, sizeof encoded->reason, "out of memory");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, encoded, keep_reason, ignore_warning);
    if (png == NULL) return false;
    png_infop info = png_create_info_struct(png);
    if (info == NULL) {
        png_destroy_write_struct(&png, NULL);
        return false;
    }
    /* png and info are not changed between setjmp and longjmp, so they keep their values. */
    if (setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, encoded, append_bytes, flush_nothing);
    write_chunks(png, info, image);
    png_destroy_write_struct(&png, &info);
    return true;
}

static bool write_file(const char *path, const uint8_t *bytes, size_t size, io_error *error) {
    output_file out;
    if (!output_file_open(path, &out))
        return io_fail(error, "%s: cannot open for writing: %s", path, strerror(errno));
    fwrite(bytes, 1, size, out.file);
    return output_file_close(&out, OUTPUT_WHOLE) ||
           io_fail(error, "%s: cannot write %zu bytes: %s", path, size, io_write_reason());
}

bool picture_image_write_png(const char *path, const picture_image *image, io_error *error) {
    encoded_png encoded = {0};
    bool written = encode_png(image, &encoded)
                       ? write_file(path, encoded.bytes, encoded.size, error)
                       : io_fail(error, "%s: cannot encode as PNG: %s", path, encoded.reason);
    free(encoded.bytes);
    return written;
}
