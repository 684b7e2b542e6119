/* Parts of the published pipelines: which way triangles face their detector points, and the elementary test. */
#pragma once

#include "runtime/baselines/plain_cubic.h"
#include "runtime/narrow_phase/narrow_phase.h"

/* Moves the detector points of the regions to the interval: they stay, or, where they are to be ours, go with the weighted mean of
 * their regions. */
void detector_points_move(const own_interval *interval, bool still);

/* Writes facing and orientations of all triangles, and how many face either way. */
void orientations_check(const own_interval *interval);

/* The elementary test as such codes have it: the real roots of the coplanarity cubic in plain doubles, and an inside test at each
 * (Provot 1997; Bridson, Fedkiw, Anderson 2002). It has no bound on its rounding, so it may err on either side. Writes the first
 * touch, as elementary_after_signs does. */
bool plain_test(const plain_cubic_functions *roots, const elementary_query *query, cscd_contact_kind kind,
                elementary_contact *contact);
