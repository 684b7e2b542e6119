/* Finds features that one direction keeps apart throughout an interval. */
#pragma once

#include "runtime/ccd/elementary.h"

#include <stdbool.h>

/* Are the two features farther apart than the distance along one of the seven directions of 14-DOPs, at both
 * ends and on the same side? Then they are throughout. The filters of the detector's methods work in floats and
 * leave out only pairs of which this is true. Asking for the features' own points gives each method the same
 * pairs, whatever its trees. */
bool directions_part(const elementary_query *query, cscd_contact_kind kind, double distance);
