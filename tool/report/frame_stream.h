/* Frames as the page stores them: positions rounded to a grid, each frame as its difference from the one
 * before. */
#pragma once

#include "tool/report/packed_array.h"

/* Records, one after the other, little endian:
 *   1, origin[3] f64, step f64, body    a new grid; the body's values are predicted by 0
 *   0, shift[3] i32, body               on the grid of the record before; predicted by its values + shift
 * A position is origin + step * value; values are i32. A body is a byte P from 1 to 4 and P planes of a byte
 * per value, the low bytes first, axis by axis. What they hold per axis are the differences from the
 * prediction, less the difference of the value before (0 before the first), and of that the zigzag:
 * (r << 1) ^ (r >> 31). All of this wraps around. */
typedef struct frame_stream {
    packed_array *bytes;
    uint32_t vertex_count;
    double scale;               /* positions are stored times this */
    double origin[3], step;     /* the grid; step 0: none yet, or one for a single point */
    int32_t *values, *previous; /* vertex_count each of x, y, z */
    uint32_t *residuals;
    uint8_t *plane;
    /* The largest error of a coordinate as the page shows it, in units of the positions given, and by the longest
     * side of its frame's box. The latter is below 2^-15, except for frames that page_coordinate limits (1 for one
     * of no size) and for frames that float32 cannot tell from a point, because they are 2^-125 of the page's unit. */
    double max_error, relative_error;
} frame_stream;

/* scale: a power of two. On false *out holds nothing to free. */
bool frame_stream_create(uint32_t vertex_count, double scale, frame_stream *out);
void frame_stream_free(frame_stream *stream); /* a zeroed struct is fine */

/* False: out of memory. */
bool frame_stream_add(frame_stream *stream, const double *positions);
