/* The charges of a component by iteration with a treecode: memory and time n log n. */
#pragma once

#include "preprocess/charge/charge.h"
#include "src/core/context.h"

/* Writes the system's charges; the potential at its points is then 1 within the tolerance, in the root of the mean square, or within
 * 1e-3 if the iteration comes no closer. INVALID_ARGUMENT: it does not even come so close, because triangles lie (almost) on each
 * other. OUT_OF_MEMORY, also for more than the limit. */
cscd_status tree_solve(cscd_context *context, charge_system *system, size_t memory_limit, double tolerance,
                       charge_timings *timings);

/* Returns the potential that is farthest from 1, the first of equals. */
uint32_t tree_solve_worst(const double *potentials, uint32_t count);
