/* How triangles faced their regions' detector points, and where these points were, as arrays of a report. */
#pragma once

#include "tool/report/orientation_row.h"
#include "tool/report/packed_array.h"
#include "tool/report/report.h"

typedef struct orientation_arrays {
    packed_array *orientations, *points; /* NULL: left out */
    uint32_t triangle_count, interval_count;
    uint8_t *last,
        *change; /* the orientations added last, four triangles a byte, and what the next change of it */
} orientation_arrays;

/* Room is left for the orientations of kept_count intervals and the points of interval_count. What would take
 * more than REPORT_MARKS_MAX is left out. On false *out holds nothing to free. */
bool orientation_arrays_create(uint32_t triangle_count, uint32_t kept_count, uint32_t interval_count,
                               orientation_arrays *out);
void orientation_arrays_free(orientation_arrays *arrays); /* a zeroed struct is fine */

/* Adds how the triangles face, XORed with the bytes added before. False: out of memory. */
bool orientation_arrays_add(orientation_arrays *arrays, const orientation_row *row);

/* Adds each region's detector point at the start and at the end of the interval, times scale. */
bool orientation_arrays_add_points(orientation_arrays *arrays, const orientation_row *row, double scale);
