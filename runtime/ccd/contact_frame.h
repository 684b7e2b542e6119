/* Describes a contact: a time that is safe to step to, the points, the normal. */
#pragma once

#include "runtime/ccd/coplanarity.h"
#include "runtime/ccd/elementary.h"

/* f: the features' coplanarity cubic. toi: not later than the first touch, and earlier by 2^-31 at most; made
 * earlier by 2^-32 at most, so that positions at it, rounded to doubles, have not passed each other yet. */
void contact_frame_describe(const elementary_query *query, cscd_contact_kind kind, const coplanarity *f,
                            double toi, elementary_hit *hit);
