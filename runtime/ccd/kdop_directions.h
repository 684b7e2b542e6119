/* Features that a direction parts throughout an interval. */
#pragma once

#include "runtime/ccd/elementary.h"

#include <stdbool.h>

/* Are the first points of a pair of features farther than the distance from the others along one of the seven
 * directions of 14-DOPs, at both ends on the same side, and so throughout? The filters of the detector's
 * methods, in floats, leave out only what certainly is so; asking on the features' own points gives each
 * method the same pairs, whatever its trees. */
bool directions_part(const elementary_query *query, cscd_contact_kind kind, double distance);
