/* Which way triangles face their detector points during an interval (Yeh 2012, section 4.4). */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* Moves the detector points of the regions to the interval: they stay, or, where they are to be ours, go with the weighted mean of
 * their regions. */
void detector_points_move(const own_interval *interval, bool still);

/* Writes facing and orientations of all triangles, and how many face either way. */
void orientations_check(const own_interval *interval);
