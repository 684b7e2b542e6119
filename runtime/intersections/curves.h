/* Joins the pieces of all pairs of triangles to intersection curves. */
#pragma once

#include "runtime/intersections/curve_links.h"

#include <cscd/intersections.h>

/* What the last call has found, and the memory of all calls. */
typedef struct curve_joiner {
    cscd_context *context;
    size_t pair_capacity, piece_capacity;

    /* Per pair. */
    curve_piece *found;    /* the first piece_count ones are the pieces in the order of the pairs */
    uint32_t *pair_pieces; /* its piece, or UINT32_MAX */
    uint32_t *pair_curves;

    /* Per piece, or per end of one. */
    curve_key *keys, *spare_keys;
    uint32_t *links;
    uint32_t *piece_curves;
    uint32_t *end_points; /* per end of a piece: its point */
    cscd_curve *curves;
    cscd_curve_piece *pieces;
    cscd_curve_point *points;
    surface_event *events; /* of the points */
    size_t pair_count, curve_count, point_count, piece_count;
} curve_joiner;

void curve_joiner_free(curve_joiner *j);

/* The bytes that a call takes at most, for so many pairs. */
size_t curve_joiner_size(size_t pair_count);

/* Finds the curves of a list of pairs a < b, sorted by (a, b): all pairs of triangles that intersect or touch, but those that
 * are left out. *out lives until the next call. OUT_OF_MEMORY has no sentence, nor CANCELLED. */
cscd_status curve_joiner_run(curve_joiner *j, const named_surface *s, const cscd_intersection_pair *pairs,
                             size_t pair_count, cscd_curves *out);
