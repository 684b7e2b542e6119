/* The limits of searches: how near is near, and how exactly. */
#pragma once

#include "runtime/ccd/min_separation.h"
#include "src/core/context.h"

/* Returns INVALID_ARGUMENT, with a sentence, unless the one is a length or 0 and the other a share of it or 0. */
cscd_status separation_check(cscd_context *context, double min_separation, double tolerance);

/* A distance and its tolerance, which is given as a share; 0: the default share. */
separation separation_limit(double distance, double tolerance);

/* Pairs within the distance are reported; pairs between it and the tolerance beyond it may be. */
separation proximity_limit(double distance);
