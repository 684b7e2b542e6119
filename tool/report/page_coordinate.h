/* Coordinates as the page has them: in its unit, and within what float32 and a graphics card can work
 * with. */
#pragma once

#include <math.h>

/* A body that grows or flies 2^100 times as far as its size at the start is shown at this limit. */
#define PAGE_COORDINATE_MAX 0x1p100

static inline double page_coordinate(double x, double scale) {
    return fmax(-PAGE_COORDINATE_MAX, fmin(PAGE_COORDINATE_MAX, x * scale));
}
