/* The contents that a report has collected for its page: arrays, which are compressed as they come, frames,
 * and what was found in them. */
#pragma once

#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/report/report.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* ---- arrays -------------------------------------------------------------------------------------------- */

/* An array of the page: values in, compressed in memory as they come, base64 out. */
typedef struct packed_array packed_array;

/* NULL: out of memory. */
packed_array *packed_array_create(void);
void packed_array_destroy(packed_array *array);

/* Little endian on every machine. False: out of memory, and the array is of no more use. */
bool packed_array_add_bytes(packed_array *array, const uint8_t *bytes, size_t count);
bool packed_array_add_u32(packed_array *array, const uint32_t *values, size_t count);
bool packed_array_add_f32(packed_array *array, const float *values, size_t count);
bool packed_array_add_f64(packed_array *array, const double *values, size_t count);

/* Ends the stream (RFC 1950); nothing can be added any more. */
bool packed_array_finish(packed_array *array);

/* The finished stream, in one line of base64. False: the file refused, errno says why. */
bool packed_array_write(const packed_array *array, FILE *file);

/* ---- frames -------------------------------------------------------------------------------------------- */

/* Positions are rounded to a grid, and a frame is stored as its difference from the one before. */

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
    /* The largest error of a coordinate as the page shows it, in units of the positions given, and by the
     * longest side of its frame's box. The latter is below 2^-15, except for frames that page_coordinate
     * limits (1 for one of no size) and for frames that float32 cannot tell from a point, because they are
     * 2^-125 of the page's unit. */
    double max_error, relative_error;
} frame_stream;

/* scale: a power of two. On false *out holds nothing to free. */
bool frame_stream_create(uint32_t vertex_count, double scale, frame_stream *out);
void frame_stream_free(frame_stream *stream); /* a zeroed struct is fine */

/* False: out of memory. */
bool frame_stream_add(frame_stream *stream, const double *positions);

/* ---- contacts ------------------------------------------------------------------------------------------ */

/* The contacts of a report: those that are kept as arrays, and how many every triangle takes part in. */
typedef struct contact_arrays {
    uint64_t found;
    uint32_t kept;
    uint32_t *heat; /* per triangle: how many contacts have it as the face, or have its vertex or edge */
    packed_array *interval, *kind, *vertices, *toi, *point;
    packed_array *file_vertices; /* NULL where the file has the mesh's numbers */
} contact_arrays;

/* On false *out holds nothing to free. */
bool contact_arrays_create(const report_options *options, contact_arrays *out);
void contact_arrays_free(contact_arrays *arrays); /* a zeroed struct is fine */

/* Points are stored times scale. False: out of memory. */
bool contact_arrays_add(contact_arrays *arrays, const report_options *options, uint32_t interval,
                        const cscd_contacts *contacts, double scale);

/* ---- answers ------------------------------------------------------------------------------------------- */

/* The numbers of one frame, in the order of the array "answer_counts". */
typedef struct answer_counts {
    uint32_t crossing;                  /* pairs that cross */
    uint32_t touching;                  /* pairs that meet otherwise */
    uint32_t triangles, points, depths; /* of each, those that are kept */
} answer_counts;

/* The intersections in each frame of a report: triangles with their kinds, points of curves, depths of
 * vertices. */
typedef struct answer_arrays {
    uint32_t frames_checked;
    answer_counts found, kept; /* of all frames: 'crossing' and 'touching' of found alone */
    uint8_t *kinds;            /* per triangle: of the frame at hand, a set of cscd_intersection_kind */
    packed_array *frame, *counts, *triangle, *kind, *point_vertices, *point_share, *point_begins,
        *depth_vertex, *depth;
} answer_arrays;

/* On false *out holds nothing to free. */
bool answer_arrays_create(const report_options *options, answer_arrays *out);
void answer_arrays_free(answer_arrays *arrays); /* a zeroed struct is fine */

/* Depths are stored times scale. False: out of memory. */
bool answer_arrays_add(answer_arrays *arrays, const report_options *options, uint32_t frame,
                       const cscd_intersections *found, double scale);

/* ---- orientations -------------------------------------------------------------------------------------- */

/* Orientations of triangles towards their regions' detector points, and the places of these points. */
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

/* ---- events -------------------------------------------------------------------------------------------- */

/* The events of a report, and the names of the parts that they are of. */
typedef struct event_list {
    cscd_event *items; /* the worst ones, in the order of the tracker */
    size_t count, found;
    report_part_name name;
    void *name_user;
    bool known;
} event_list;

/* Copies the events. False: out of memory, and the list holds nothing to free. */
bool event_list_set(event_list *list, const cscd_event *events, size_t count, report_part_name name,
                    void *user);
void event_list_free(event_list *list); /* a zeroed struct is fine */

/* ---- coordinates --------------------------------------------------------------------------------------- */

/* The page has coordinates in its unit, and within what float32 and a graphics card can work with. */

/* A body that grows or flies 2^100 times as far as its size at the start is shown at this limit. */
#define PAGE_COORDINATE_MAX 0x1p100

static inline double page_coordinate(double x, double scale) {
    return fmax(-PAGE_COORDINATE_MAX, fmin(PAGE_COORDINATE_MAX, x * scale));
}

/* ---- the report ---------------------------------------------------------------------------------------- */

struct report {
    report_options options;
    double unit;           /* a power of two: the page's positions are in this many of the files' units */
    uint32_t stride, last; /* every stride-th frame is kept; the frame given last */
    growable kept;         /* uint32_t: the frames in the stream */
    bool last_is_kept;
    double *last_positions; /* NULL where every frame is kept */
    frame_stream frames, scenery;
    contact_arrays contacts;         /* of a replay */
    answer_arrays answers;           /* of a replay */
    event_list events;               /* of a replay */
    orientation_arrays orientations; /* of a replay whose method has them */
};

/* Puts the last frame into the stream, if it is not there yet. */
bool report_keep_last(report *r);
