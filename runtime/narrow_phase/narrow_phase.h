/* From triangle pairs to contacts: representatives, feature volumes, elementary tests. */
#pragma once

#include "runtime/narrow_phase/contact_lane.h"
#include "runtime/narrow_phase/orphan_pairs.h"
#include "runtime/narrow_phase/swept_interval.h"

/* These put pairs in the lane's queue, which is decided when it is full, and by: */
void narrow_phase_finish(const swept_interval *interval, contact_lane *lane);

/* All pairs of features that pairs of triangles, given by their slots, answer for, that share no vertex and
 * that may touch by their volumes. */
void narrow_phase_test(const swept_interval *interval, const triangle_pair *pairs, uint32_t count,
                       contact_lane *lane);

/* The orphan pairs index, index + stride, and so on from the lane's cursor on, but those that a direction parts. The
 * lane may be suspended on the way. */
void narrow_phase_test_orphan_pairs(const swept_interval *interval, const orphan_pairs *orphans,
                                    uint32_t index, uint32_t stride, contact_lane *lane);

/* One pair of features without a common vertex: a contact where they touch, or come within the limit's
 * distance. */
void narrow_phase_test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                          contact_lane *lane);
void narrow_phase_test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_lane *lane);
