/* What falls and what it falls onto: sheets, tubes, boxes and balls as meshes. z is up, lengths in metres. */
#ifndef CSCD_MODELS_GARMENT_H
#define CSCD_MODELS_GARMENT_H

#include "models/shapes/body.h"
#include "src/io/io_error.h"

/* Each adds one component to the body. Positions are those of their file: exact in single precision. */

/* An open square in the plane z = 0 about the origin: side * side vertices, 2 or more a side. Its edges run
 * along and across, and from cell to cell along the one diagonal and the other. */
void garment_add_sheet(body *b, uint32_t side, double width);

/* A closed tube with flat ends and rounded rims that stands on z = 0 about the z axis, of even triangles:
 * exactly triangle_count, an even number, some hundred at least. */
void garment_add_tube(body *b, uint32_t triangle_count, double radius, double height);

/* A flat box about the z axis with its top at z = 0: `reach` to each side, a tenth of it high. */
void garment_add_box(body *b, double reach);

/* About the origin, of about triangle_count triangles. */
bool garment_add_ball(body *b, uint32_t triangle_count, double radius, io_error *error);

#endif
