/* Many pictures of one size in one: a grid of tiles. */
#pragma once

#include "tool/picture/image.h"

typedef struct picture_sheet {
    picture_image image;
    uint32_t columns, tile_width, tile_height;
} picture_sheet;

/* White with thin lines between the tiles, exactly columns x ceil(tile_count / columns) tiles large. On false
 * *out is untouched. */
bool picture_sheet_create(uint32_t tile_count, uint32_t columns, uint32_t tile_width, uint32_t tile_height,
                          picture_sheet *out, io_error *error);

/* Copies the tile, which has the sheet's tile size, to place `index`, counted row by row from the upper left
 * corner; the lines stay, one pixel inside its left and upper side. */
void picture_sheet_place(picture_sheet *sheet, uint32_t index, const picture_image *tile);
