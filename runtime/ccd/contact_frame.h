/* Describes a contact: a time that is safe to step to, the points and the normal. */
#pragma once

#include "runtime/ccd/coplanarity.h"
#include "runtime/ccd/elementary.h"

/* f is the features' coplanarity cubic. toi is not after the first touch, and before it by at most 2^-31.
 * contact->toi is earlier than toi by at most 2^-32, so that positions at it, rounded to doubles, have not passed
 * each other yet. */
void contact_frame_describe(const elementary_query *query, cscd_contact_kind kind, const coplanarity *f,
                            double toi, elementary_contact *contact);
