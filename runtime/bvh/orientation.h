/* Orientation of triangles as seen from a detector point during a whole interval. */
#pragma once

#include "src/mesh/mesh.h"

/* PLUS (MINUS): (p0 - d) . n > 0 (< 0), with n = (p1 - p0) x (p2 - p0) and d the detector point, at every
 * moment of the interval, certified; ZERO: anything else. */
enum { ORIENTATION_PLUS = 1, ORIENTATION_MINUS = 2, ORIENTATION_ZERO = 3 };

/* May triangles of one region with these flags, or any of two sets of them, be the first to touch? Not if
 * all are PLUS, and not if all are MINUS: see docs/theory/culling.md. */
static inline bool orientations_may_touch(uint8_t a, uint8_t b) {
    return (a | b) == ORIENTATION_ZERO;
}
