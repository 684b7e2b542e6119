/* What traces of curves cut off of open surfaces. */
#pragma once

#include "runtime/intersections/triangle_cuts.h"

#include <cscd/cut_offs.h>

/* The memory of all calls. */
typedef struct cut_off_finder cut_off_finder;

/* NULL: no memory. */
cut_off_finder *cut_off_finder_create(cscd_context *context);

/* NULL is allowed. */
void cut_off_finder_destroy(cut_off_finder *f);

/* Gives back what it keeps from one call to the next. */
void cut_off_finder_clear(cut_off_finder *f);

/* Patches have been found. OUT_OF_MEMORY and CANCELLED have no sentence. */
cscd_status cut_off_finder_run(cut_off_finder *f, const surface_cuts *found, cscd_cut_offs *out);
