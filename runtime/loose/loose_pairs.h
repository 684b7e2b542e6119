/* Pairs of features of which one is loose: those that count go to the lane's queue. */
#pragma once

#include "runtime/loose/loose_elements.h"
#include "runtime/narrow_phase/narrow_phase.h"

/* A face and the ends of an element that this tests, and the triangle's own edges and a wire. The objects are looked at
 * with each other. */
void loose_pairs_with_triangle(const swept_interval *interval, const loose_element *element,
                               uint32_t triangle, contact_lane *lane);

/* Two elements: nothing, unless their objects are looked at with each other and they share no vertex. */
void loose_pairs_of_elements(const swept_interval *interval, const loose_element *a, const loose_element *b,
                             contact_lane *lane);

/* Are two elements, by their numbers as edges, ever in contact? Where a point and a wire, or two points, have no distance
 * to keep they are not looked at: as they move they never meet exactly, or only where rounding decides. */
static inline bool loose_edges_meet(const swept_interval *interval, uint32_t a, uint32_t b) {
    uint32_t larger = a > b ? a : b;
    return !edge_is_point(interval->mesh, larger) ||
           pair_separation(interval, CSCD_CONTACT_EE, a, b).distance > 0.0;
}
