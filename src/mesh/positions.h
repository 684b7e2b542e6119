/* Checks the coordinates of positions. */
#pragma once

#include "src/core/context.h"

/* Every coordinate must be 0 or have a magnitude in [2^-300, 2^300], so that no product of the exact
 * predicates over- or underflows. INVALID_ARGUMENT names the vertex; name says which array. */
cscd_status positions_check(cscd_context *context, const double *positions, uint32_t vertex_count,
                            const char *name);
