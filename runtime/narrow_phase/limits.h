/* The limits of searches: how near is near, and how exactly. */
#pragma once

#include "runtime/ccd/min_separation.h"
#include "src/core/context.h"

/* Returns INVALID_ARGUMENT, with a sentence, unless both are lengths or 0. */
cscd_status separation_check(cscd_context *context, double min_separation, double tolerance);

/* Both as a limit, with the default tolerance filled in. */
separation separation_limit(double min_separation, double tolerance);

/* Pairs within the distance are reported; pairs between it and the tolerance beyond it may be. */
separation proximity_limit(double distance);
