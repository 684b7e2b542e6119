/* Separating directions of level one: planes that keep two moving features apart during the whole interval.
 */
#ifndef CSCD_SEPARATING_H
#define CSCD_SEPARATING_H

#include "runtime/elementary.h"

/* True: certainly apart; the points of the features are compared at one time, so this rejects whatever the
 * features' swept 14-DOPs would. first_count: 1 for VF, 2 for EE. */
bool separated_by_axes(const elementary_query *query, int first_count);

/* The same by directions in the features' common plane at mid-interval, for points that are nearly coplanar.
 */
bool separated_in_plane(const elementary_query *query, int first_count);

#endif
