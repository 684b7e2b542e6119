/* Pairs of features of which one is loose: those that count go to the lane's queue. */
#include "runtime/loose/loose_pairs.h"

#include "runtime/ccd/ccd.h"
#include "runtime/narrow_phase/narrow_phase.h"

static bool parted_by_directions(const swept_interval *interval, cscd_contact_kind kind, uint32_t a,
                                 uint32_t b) {
    elementary_query query;
    swept_interval_load(interval, kind, a, b, &query);
    return directions_part(&query, kind, pair_reach(interval, kind, a, b));
}

static void test_end(const swept_interval *interval, uint32_t vertex, uint32_t triangle, contact_lane *lane) {
    if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_VF, vertex, triangle)) return;
    if (parted_by_directions(interval, CSCD_CONTACT_VF, vertex, triangle)) return;
    lane->feature_pairs++;
    narrow_phase_test_vf(interval, vertex, triangle, lane);
}

static void test_edges(const swept_interval *interval, uint32_t a, uint32_t b, contact_lane *lane) {
    if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_EE, a, b)) return;
    if (parted_by_directions(interval, CSCD_CONTACT_EE, a < b ? a : b, a < b ? b : a)) return;
    lane->feature_pairs++;
    narrow_phase_test_ee(interval, a, b, lane);
}

void loose_pairs_with_triangle(const swept_interval *interval, const loose_element *element,
                               uint32_t triangle, contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    for (int i = 0; i < 2; i++) {
        if ((element->ends >> i & 1) != 0) test_end(interval, mesh->edges[element->edge][i], triangle, lane);
    }
    if (edge_is_point(mesh, element->edge)) return;
    uint32_t owned = represented_features(interval->representatives, triangle) >> 3;
    for (int i = 0; i < 3; i++) {
        if ((owned >> i & 1) != 0)
            test_edges(interval, element->edge, mesh->triangle_edges[triangle][i], lane);
    }
}

void loose_pairs_of_elements(const swept_interval *interval, const loose_element *a, const loose_element *b,
                             contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    if (!pair_filter_admits_objects(&interval->filter, a->object, b->object)) return;
    if (edges_share_vertex(mesh->edges[a->edge], mesh->edges[b->edge])) return;
    if (loose_edges_meet(interval, a->edge, b->edge)) test_edges(interval, a->edge, b->edge, lane);
}
