/* How the triangles faced their regions' detector points in one interval, and where these points were. */
#pragma once

#include "cscd/cscd.h"

#include <stddef.h>

typedef struct orientation_row {
    uint32_t triangle_count,
        region_count;    /* no regions: the method has no detector points, and there are no orientations */
    double (*points)[6]; /* per region: where it is at the start, and at the end */
    uint8_t *facing;     /* two bits a triangle, four to a byte, the first lowest: 0: neither, 1: S+, 2: S- */
} orientation_row;

/* Bytes of facing. */
static inline size_t orientation_row_size(uint32_t triangle_count) {
    return ((size_t)triangle_count + 3) / 4;
}

/* Room for the rows of a detector, filled by _take. False: out of memory; *out then holds nothing to free. */
bool orientation_row_create(const cscd_detector *detector, const cscd_mesh *mesh, orientation_row *out);
void orientation_row_free(orientation_row *row); /* a zeroed struct is fine */

/* Those of the detector's last step. */
void orientation_row_take(orientation_row *row, const cscd_detector *detector);

/* Those of a step that has none: no triangle faces any point. */
void orientation_row_forget(orientation_row *row);
