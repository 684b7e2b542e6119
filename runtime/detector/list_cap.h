/* A cap on the length of lists: contacts that find no room are counted, and leave nothing behind but taint. */
#pragma once

#include "runtime/culling/culling.h"
#include "runtime/detector/detector.h"

/* Which contacts that leave the lanes taint triangles: all of them, or, in a search of a moment, those that are left
 * out and may touch on the way of a motion that begins there. Where only the earliest contacts are listed, those leave the
 * lanes that neither taint nor are listed. */
typedef enum cap_taint { CAP_TAINTS_ALL, CAP_TAINTS_LEFT_OUT, CAP_KEEPS_EARLIEST } cap_taint;

/* Sets the cap of the options from now on; 0: none. */
cscd_status list_cap_set(cscd_detector *d, size_t longest);

/* The number of contacts that a lane has room for before it is suspended. */
size_t list_cap_lane(const cscd_detector *d);

/* Lets the search that has just begun keep no more contacts than the cap allows. */
void list_cap_begin(cscd_detector *d, interval_search *search, cap_taint taint);

/* Taints by the contacts that have left the lanes since the last call. Returns how many triangles are newly kept. */
uint32_t list_cap_taint(cscd_detector *d, const tainting *t);

/* LIST_TOO_LONG, with its sentence. */
cscd_status list_cap_fail(const cscd_detector *d, size_t count);

/* Lets static checks keep no more pairs in their lanes than the longest list allows, until list_cap_end_check; 0: no list
 * is made of them, so lanes need room for few. spill takes pairs from the lanes as they fill; NULL drops them, since their
 * triangles are marked. */
void list_cap_begin_pairs(cscd_detector *d, size_t longest, void (*spill)(void *data), void *data);
void list_cap_end_check(cscd_detector *d);
