/* Features that do not move: whether they touch, by the signs of a few determinants. */
#pragma once

#include "runtime/ccd/elementary.h"

/* Returns whether no point of the pair moves. If so, decides it as elementary_after_signs does, with the same contact, but
 * sooner. */
bool still_pair_decide(const elementary_query *query, cscd_contact_kind kind, elementary_verdict *verdict,
                       elementary_contact *contact);
