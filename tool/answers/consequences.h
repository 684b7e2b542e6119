/* Events that only follow from others. */
#pragma once

#include "cscd/events.h"

#include <stdbool.h>

/* Leaves out the events of duplicates alone, and those of one part in itself, without a pair or a contact, that happen while
 * another event of the part has pairs: some part cuts this one, and the surface nearest to what that buries happens to be its
 * own. What lies in itself at any other time stays. The others keep their order. Returns false, and changes nothing, when out
 * of memory. */
bool consequences_leave_out(cscd_event *events, size_t *count);
