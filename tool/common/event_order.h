/* The order of events, the worst first. */
#pragma once

#include "cscd/events.h"

#include <stdbool.h>

/* Is all that the event has that one part lies in itself, within one body, without a pair or a contact? */
bool event_is_in_itself(const cscd_event *event);

/* Sorts pointers into one array. What crosses or overlaps comes before what touches, then contacts. What is only in itself
 * comes after all others: some other part cuts it, and the nearest surface to what that buries
 * happens to be its own. Of one rank the deeper events come first, then those with longer curves, more pairs, more contacts, and
 * of those that have all of these in common the one that stands first in the array. */
void event_order_sort(const cscd_event **events, size_t count);
