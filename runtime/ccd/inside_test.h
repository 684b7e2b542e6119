/* The inside test of level two: are two features' points, coplanar at some time in an interval, in touch? */
#pragma once

#include "runtime/ccd/coplanarity.h"
#include "runtime/ccd/cubic.h"

typedef enum inside_verdict { INSIDE_NO, INSIDE_YES, INSIDE_UNSURE } inside_verdict;

/* Says whether the features touch at none (NO) or at every one (YES) of the times in the interval at which
 * the four points are coplanar. The answer is certified. */
inside_verdict inside_test(const point_vectors *vectors, cscd_contact_kind kind,
                           const root_interval *interval);
