/* Minimum separation: do a moving vertex and face, or two moving edges, come within a distance, and when? */
#pragma once

#include "runtime/ccd/feature_moment.h"

/* Both are lengths above 0. */
typedef struct separation {
    double distance, tolerance;
} separation;

/* Returns INVALID_ARGUMENT, with a sentence, unless the one is a length or 0 and the other a share of it or 0. */
cscd_status separation_check(cscd_context *context, double min_separation, double tolerance);

/* A distance and its tolerance, which is given as a share; 0: the default share. */
separation separation_limit(double distance, double tolerance);

/* Pairs within the distance are reported; pairs between it and the tolerance beyond it may be. */
separation proximity_limit(double distance);

/* Limits the steps from one moment to the next. Of 7.3 million tests in two frames of cloth in heavy contact,
 * with a distance of 1e-3 of the diagonal, five took 16 steps or more and none took 64. Of 20 million tests
 * on other recordings none took 16. */
enum { SEPARATION_STEPS_MAX = 128 };

/* The finest tolerance that separation_vf and separation_ee can promise, as a fraction of the query's extent.
 * The extent is the largest difference of a coordinate from that of the first point at t = 0. */
#define SEPARATION_FINEST 0x1p-42

/* These return true for all features that come within the distance. contact->toi is never after the first moment
 * at which they do. u and v name the nearest points at that time, and normal points from b's point to a's.
 * The points are then at most distance + max(tolerance, SEPARATION_FINEST * extent) apart, unless *bounded is
 * set: then the steps ran out, and toi is the last moment before which the features were proven farther apart
 * than the distance. *contact and *bounded are written only when true is returned. */
bool separation_vf(const elementary_query *query, const separation *limit, elementary_contact *contact,
                   bool *bounded);
bool separation_ee(const elementary_query *query, const separation *limit, elementary_contact *contact,
                   bool *bounded);

/* The finest tolerance in the units of a local query. Its extent is at least 1/2, so this is no larger than promised.
 * It is 16 times the error of a distance and 8 times SEPARATING_PLANE_ERROR, so the steps get down to distance and
 * tolerance and do not end before them. */
#define SEPARATION_FINEST_LOCAL (0.5 * SEPARATION_FINEST)

/* The same for a query in its own frame, with its distance and the tolerance scaled. */
bool approach_within(const elementary_query *query, const local_query *local, double tolerance,
                     elementary_contact *contact, bool *bounded);

/* The nearest points at the start, as a contact at time 0. */
void separation_describe(const elementary_query *query, cscd_contact_kind kind, elementary_contact *contact);
