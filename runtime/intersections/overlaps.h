/* The areas and volumes that bodies bury of each other, by the patches and by the triangles that curves cut. */
#pragma once

#include "runtime/intersections/overlap_gaps.h"

/* The memory of all calls. */
typedef struct overlap_finder overlap_finder;

/* NULL: no memory. */
overlap_finder *overlap_finder_create(cscd_context *context);

/* NULL is allowed. */
void overlap_finder_destroy(overlap_finder *o);

/* Gives back what it keeps from one call to the next. */
void overlap_finder_clear(overlap_finder *o);

/* *out lives until the next call. OUT_OF_MEMORY has no sentence. */
cscd_status overlap_finder_run(overlap_finder *o, const surface_cuts *found, const left_out_pairs *left_out,
                               cscd_overlaps *out);
