/* Level three of the elementary tests: do two moving features touch, decided in exact arithmetic. */
#pragma once

#include "runtime/ccd/elementary.h"
#include "runtime/ccd/exact/integer.h"

/* Returns true when the features touch at some t in [0,1]. *toi is then the greatest multiple of 2^-34 that is not
 * above the first such t. Coordinates are 0 or have a magnitude in [2^-300, 2^300]. */
bool exact_touch(const elementary_query *query, cscd_contact_kind kind, double *toi);

/* The same with the caller's pool, whose peak then tells how much room was needed. */
bool exact_touch_in(integer_pool *pool, const elementary_query *query, cscd_contact_kind kind, double *toi);
