/* A small bitmap font: printable ASCII, five dots wide, seven high and one more for descenders. */
#pragma once

#define PICTURE_GLYPH_WIDTH  5
#define PICTURE_GLYPH_HEIGHT 8

/* How much (0..1) the glyph covers of a pixel at (x, y) in dots from its upper left corner, for `scale`
 * pixels a dot: corners are rounded and rims smoothed as the scale grows. */
double picture_glyph_coverage(char character, double x, double y, double scale);
