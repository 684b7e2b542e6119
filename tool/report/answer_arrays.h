/* What intersects in each frame of a report: triangles with their kinds, points of curves, depths of vertices. */
#pragma once

#include "tool/report/packed_array.h"
#include "tool/report/report.h"

/* The numbers of one frame, in the order of the array "answer_counts". */
typedef struct answer_counts {
    uint32_t crossing;                  /* pairs that cross */
    uint32_t touching;                  /* pairs that meet otherwise */
    uint32_t triangles, points, depths; /* so many of each are kept */
} answer_counts;

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
                       const cscd_intersection_pairs *found, double scale);
