/* What falls and what it falls onto: sheets, tubes, boxes and balls as meshes. z is up, lengths in metres. */
#pragma once

#include "models/shapes/body.h"
#include "src/io/io_error.h"

/* Each adds one component to the body. Positions are those of their file: exact in single precision. */

/* An open square in the plane z = 0 about the origin: side * side vertices, 2 or more a side. Its edges run
 * along and across, and from cell to cell along the one diagonal and the other. */
void garment_add_sheet(body *b, uint32_t side, double width);

/* Two open panels of columns * rows vertices, to be sewn together at the sides and at the upper edge. They
 * stand on z = 0 in the plane y = 0 and bulge by `depth` to both sides at the open lower edge. */
void garment_add_bag(body *b, uint32_t columns, uint32_t rows, double width, double height, double depth);

/* The seams of a bag that is the whole body: *pair_count pairs of vertices that lie on each other, to be
 * freed. */
uint32_t *garment_bag_seams(uint32_t columns, uint32_t rows, uint32_t *pair_count);

/* A closed tube with flat ends and rounded rims that stands on z = 0 about the z axis, of even triangles:
 * exactly triangle_count, an even number, some hundred at least. */
void garment_add_tube(body *b, uint32_t triangle_count, double radius, double height);

/* A flat box about the z axis with its top at z = 0: `reach` to each side, a tenth of it high. */
void garment_add_box(body *b, double reach);

/* About the origin, of about triangle_count triangles. */
bool garment_add_ball(body *b, uint32_t triangle_count, double radius, io_error *error);
