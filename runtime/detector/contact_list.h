/* The interval's contacts from all threads as one sorted list. */
#pragma once

#include "runtime/detector/detector.h"

/* Joins the lanes' contacts in the detector's buffer, leaves out the pairs that its options ignore, sorts by
 * (toi, kind, a, b), and adds up the lanes' counters. */
cscd_status contact_list_collect(cscd_detector *detector, cscd_counters *counters, cscd_contacts *out);

/* Do the options leave this one out? */
bool contact_list_leaves_out(const cscd_detector *detector, const cscd_contact *contact);

/* How many contacts each lane finds differs from run to run: without this a buffer might grow in an interval
 * like those before. found: by all lanes together. */
cscd_status contact_list_reserve_lanes(cscd_detector *detector, size_t found);
