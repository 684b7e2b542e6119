/* Volumes by columns: along many lines, the parts on which a body has a number. An estimate, whose error falls with the
 * distance of the lines. */
#pragma once

#include <stdint.h>

/* A closed surface of one object. */
typedef struct column_body {
    const double *positions;
    const uint32_t *triangles;
    uint32_t triangle_count;
} column_body;

/* The volume of what has a winding number of at least least_a in a, and of at least 1 in b; b NULL: everywhere. lines:
 * along x, and along y. */
double column_volume(const column_body *a, const column_body *b, int least_a, int lines);
