/* Mode EARLIEST: of the contacts of a component with itself, only the earliest are listed. */
#pragma once

#include "runtime/detector/detector.h"

/* A contact is listed if its toi exceeds the least one of its component by at most this. A toi is never late, and early by
 * less than this (docs/theory/elementary.md). */
static const double earliest_share = 1e-9;

/* Closing passes have to find every contact whose true time is at most that of the latest one that may be listed, so
 * contacts up to here taint (docs/theory/culling.md, Corollary 3). */
static const double earliest_tainting = 2e-9;

/* Begins an interval: no contact is noted. */
void earliest_begin(cscd_detector *d);

/* Notes the contacts that the lanes have gained since contacts_seen. */
void earliest_note(cscd_detector *d);

/* Takes the contacts of components with themselves out of the lanes whose toi exceeds the earliest one by more than
 * `within`. The earliest have been noted. */
void earliest_drop_later(cscd_detector *d, double within);

/* Makes room in lanes that are suspended (list_cap.h): drops what is not listed and taints nothing. data: the
 * detector. */
void earliest_spill(void *data);
