/* What wires, points and half-spaces may touch: pairs with triangles, by the trees of these, with each other, and with
 * vertices. */
#pragma once

#include "runtime/loose/loose_elements.h"
#include "runtime/narrow_phase/narrow_phase.h"

/* A search of the interval, whose trees have been refitted to it, and whose elements have been moved. */
typedef struct loose_search {
    const swept_interval *interval;
    const loose_elements *elements;
    uint32_t lane_count; /* that share the search */
} loose_search;

/* Puts the lane's share of all pairs that may come within their distance in the lane's queue, and decides them. Which lane
 * has which pair depends on the number of lanes alone. */
void loose_search_test(const loose_search *search, uint32_t lane_index, contact_lane *lane);

/* The same for every pair, without a box: the reference. */
void loose_search_test_all(const loose_search *search, uint32_t lane_index, contact_lane *lane);

/* Tests one pair, named as in a cscd_contact; of triangles, too. */
void loose_search_test_pair(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                            contact_lane *lane);

/* One vertex and a half-space. */
void half_spaces_test_vertex(const swept_interval *interval, uint32_t vertex, uint32_t object,
                             contact_lane *lane);

/* The lane's share of vertices against half-spaces. Candidates are never collected of these: a test costs no more. */
void half_spaces_test(const swept_interval *interval, uint32_t lane_index, uint32_t lane_count,
                      contact_lane *lane);
