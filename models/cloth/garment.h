/* Sheets, tubes, boxes and balls as meshes: garments and obstacles. z is up, lengths are in metres. */
#pragma once

#include "models/shapes/body.h"
#include "tool/io/io_error.h"

/* Each function adds one component. Positions are exact in single precision, as in files. */

/* Adds an open square in the plane z = 0 about the origin, with side * side vertices; side is at least 2.
 * Its edges run along and across, and along the two diagonals from cell to cell in turn. */
void garment_add_sheet(body *b, uint32_t side, double width);

/* Adds two open panels of columns * rows vertices, to be sewn together at the sides and at the upper edge.
 * They stand on z = 0 in the plane y = 0 and bulge by `depth` to both sides at the open lower edge. */
void garment_add_bag(body *b, uint32_t columns, uint32_t rows, double width, double height, double depth);

/* Returns the seams of a bag that is the whole body: *pair_count pairs of vertices with equal positions,
 * to be freed. */
uint32_t *garment_bag_seams(uint32_t columns, uint32_t rows, uint32_t *pair_count);

/* Adds a closed tube with flat ends and rounded rims, which stands on z = 0 about the z axis. It has
 * exactly triangle_count even triangles; the count is even and some hundred at least. */
void garment_add_tube(body *b, uint32_t triangle_count, double radius, double height);

/* Adds a flat box about the z axis with its top at z = 0: `reach` wide to each side, and a tenth of it
 * high. */
void garment_add_box(body *b, double reach);

/* Adds a ball about the origin of about triangle_count triangles. */
bool garment_add_ball(body *b, uint32_t triangle_count, double radius, io_error *error);
