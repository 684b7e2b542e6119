/* Every pair of features that share no vertex: the reference that the other methods must equal. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* Runs the share lane_index of lane_count of all pairs. Shares nothing with the trees: pairs are rejected by
 * their own boxes in double, which loses none, and by the test of the pair. */
void brute_force_test(const swept_interval *interval, uint32_t lane_index, uint32_t lane_count,
                      contact_lane *lane);
