/* The interval's contacts from all threads as one sorted list. */
#ifndef CSCD_CONTACT_LIST_H
#define CSCD_CONTACT_LIST_H

#include "runtime/detector.h"

/* Joins the lanes' contacts in the detector's buffer, leaves out the pairs that its options ignore, sorts by
 * (toi, kind, a, b), and adds up the lanes' counters. */
cscd_status contact_list_collect(cscd_detector *detector, cscd_counters *counters, cscd_contacts *out);

#endif
