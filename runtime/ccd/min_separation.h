/* Minimum separation: do a moving vertex and face, or two moving edges, come within a distance, and when? */
#pragma once

#include "runtime/ccd/elementary.h"

/* Lengths, both above 0. */
typedef struct separation {
    double distance, tolerance;
} separation;

/* The most steps from one moment to the next. (Of 7.3 million tests of two frames of cloth in heavy contact,
 * with a distance of 1e-3 of the diagonal, five took 16 or more, none 64; of 20 million on other recordings
 * none 16.) */
enum { SEPARATION_STEPS_MAX = 128 };

/* What separation_vf and _ee cannot promise to be finer than, as a fraction of the query's extent: the
 * largest difference of a coordinate from that of the first point at t = 0. */
#define SEPARATION_FINEST 0x1p-42

/* True for all features that come within distance. hit->toi is never after the first moment at which they
 * do; u and v name the nearest points then, normal points from b's to a's. Their distance is then at most
 * distance + max(tolerance, SEPARATION_FINEST * extent), unless *bounded: the steps ran out, and toi is the
 * last moment before which the features were proven farther apart than distance. *hit and *bounded are
 * written when true is returned only. */
bool separation_vf(const elementary_query *query, const separation *limit, elementary_hit *hit,
                   bool *bounded);
bool separation_ee(const elementary_query *query, const separation *limit, elementary_hit *hit,
                   bool *bounded);
