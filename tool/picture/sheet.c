/* Many pictures of one size in one: a grid of tiles. */
#include "tool/picture/sheet.h"

#include <assert.h>
#include <string.h>

static const uint8_t line_colour[3] = {150, 152, 156};

/* Lines to the left and above, but not at the rim of the sheet. */
static void rule_place(picture_sheet *sheet, uint32_t index) {
    uint32_t left = index % sheet->columns * sheet->tile_width,
             top = index / sheet->columns * sheet->tile_height;
    for (uint32_t row = 0; left > 0 && row < sheet->tile_height; row++)
        picture_image_blend(&sheet->image, left, top + row, line_colour, 1.0);
    for (uint32_t column = 0; top > 0 && column < sheet->tile_width; column++)
        picture_image_blend(&sheet->image, left + column, top, line_colour, 1.0);
}

bool picture_sheet_create(uint32_t tile_count, uint32_t columns, uint32_t tile_width, uint32_t tile_height,
                          picture_sheet *out, io_error *error) {
    uint64_t rows = columns > 0 ? ((uint64_t)tile_count + columns - 1) / columns : 0;
    uint64_t width = (uint64_t)columns * tile_width, height = rows * tile_height;
    if (width == 0 || height == 0 || width > PICTURE_SIDE_MAX || height > PICTURE_SIDE_MAX)
        return io_fail(error,
                       "%u tiles of %u x %u pixels in %u columns make %llu x %llu pixels: each side must be "
                       "1 to %u; draw fewer or smaller tiles",
                       (unsigned)tile_count, (unsigned)tile_width, (unsigned)tile_height, (unsigned)columns,
                       (unsigned long long)width, (unsigned long long)height, PICTURE_SIDE_MAX);
    picture_sheet sheet = {.columns = columns, .tile_width = tile_width, .tile_height = tile_height};
    if (!picture_image_create((uint32_t)width, (uint32_t)height, &sheet.image, error)) return false;
    memset(sheet.image.pixels, 255, (size_t)width * height * 4);
    for (uint32_t i = 0; i < rows * columns; i++) rule_place(&sheet, i);
    *out = sheet;
    return true;
}

void picture_sheet_place(picture_sheet *sheet, uint32_t index, const picture_image *tile) {
    uint32_t left = index % sheet->columns * sheet->tile_width,
             top = index / sheet->columns * sheet->tile_height;
    picture_image *image = &sheet->image;
    assert(top + sheet->tile_height <= image->height);
    assert(tile->width == sheet->tile_width && tile->height == sheet->tile_height);
    for (uint32_t row = 0; row < sheet->tile_height; row++)
        memcpy(image->pixels + 4 * ((size_t)(top + row) * image->width + left),
               tile->pixels + 4 * (size_t)row * tile->width, 4 * (size_t)tile->width);
    rule_place(sheet, index);
}
