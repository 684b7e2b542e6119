/* What traces of curves cut off of open surfaces. */
#pragma once

#include "runtime/intersections/trace_sides.h"

/* A piece of a trace, by its triangle. */
typedef struct trace_piece {
    uint64_t triangle;
    uint64_t piece; /* in the list of all pieces of curves */
} trace_piece;

/* The memory of all calls; begins with nothing but the context set. */
typedef struct cut_off_finder {
    cscd_context *context;
    trace_links links;
    trace_sides sides;
    double
        *patch_areas; /* of its triangles; of those that curves cut, the patch of the first corner has all */
    size_t patch_capacity;
    double *component_areas;
    size_t component_capacity;
    cscd_cut_off *items;
    size_t curve_capacity;
    trace_piece *pieces, *spare_pieces; /* of one trace */
    cut_line *lines;
    cut_border *borders, *spare_borders;
    size_t piece_capacity;
    cut_memory memory;
    uint64_t *sorted, *spare_sorted; /* patches of one side */
    uint32_t *listed;
    size_t listed_count, listed_capacity, item_count;
} cut_off_finder;

void cut_off_finder_free(cut_off_finder *f);

/* Patches have been found. OUT_OF_MEMORY and CANCELLED have no sentence. */
cscd_status cut_off_finder_run(cut_off_finder *f, const surface_cuts *found, cscd_cut_offs *out);
