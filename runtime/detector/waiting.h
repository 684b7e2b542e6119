/* Pairs that wait on a live detector: what a change of seams, ignored pairs or rules uncovers while it touches. */
#pragma once

#include "runtime/detector/config.h"
#include "runtime/intersections/intersections.h"

/* The means to look for pairs. */
typedef struct waiting_place {
    detector_config *config;
    search_space *space;
    bvh_rebuild *rebuild;
    static_check *check;
} waiting_place;

/* To be called where a motion starts, or a check looks, in a call that has begun: pairs that a change since the last
 * call has uncovered begin to wait if a step at rest would report them, and pairs that it would not report are let go.
 * The trees follow to x where there was such a change. */
cscd_status waiting_settle(const waiting_place *at, const double *x);

/* To be called after either, in a call whose motion starts at x and keeps floors: until the call ends, only those that
 * touch at x are left out. A pair that waits and does not touch has a floor, and passes through nothing. */
cscd_status waiting_only_touching(const waiting_place *at, const double *x);

/* The same for positions where no motion need start: no pair is let go. */
cscd_status waiting_look(const waiting_place *at, const double *x);
