/* Every pair of features of which one is a wire or a point, without boxes of boxes: the reference for the search. */
#include "runtime/loose/loose_pairs.h"
#include "runtime/loose/loose_search.h"
#include "runtime/narrow_phase/narrow_phase.h"

static void test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle, contact_lane *lane) {
    if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_VF, vertex, triangle)) return;
    swept_box a = swept_box_of(interval, &vertex, 1),
              b = swept_box_of(interval, interval->mesh->triangles[triangle], 3);
    lane->feature_pairs++;
    if (swept_boxes_within(&a, &b, pair_reach(interval, CSCD_CONTACT_VF, vertex, triangle)))
        narrow_phase_test_vf(interval, vertex, triangle, lane);
}

static void test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_lane *lane) {
    if (!loose_edges_meet(interval, a, b) ||
        !pair_filter_admits_features(&interval->filter, CSCD_CONTACT_EE, a, b))
        return;
    swept_box box_a = swept_box_of(interval, interval->mesh->edges[a], 2),
              box_b = swept_box_of(interval, interval->mesh->edges[b], 2);
    lane->feature_pairs++;
    if (swept_boxes_within(&box_a, &box_b, pair_reach(interval, CSCD_CONTACT_EE, a, b)))
        narrow_phase_test_ee(interval, a, b, lane);
}

static uint32_t object_of_triangle(const cscd_mesh *mesh, uint32_t triangle) {
    return cscd_mesh_vertex_object(mesh, mesh->triangles[triangle][0]);
}

static void test_triangles(const swept_interval *interval, const loose_element *element, contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!pair_filter_admits_objects(&interval->filter, element->object, object_of_triangle(mesh, t)))
            continue;
        for (int i = 0; i < 2; i++) {
            if ((element->ends >> i & 1) != 0) test_vf(interval, mesh->edges[element->edge][i], t, lane);
        }
    }
}

/* Edges of triangles, and then the elements that come later. */
static void test_edges(const loose_search *s, uint32_t index, contact_lane *lane) {
    const cscd_mesh *mesh = s->interval->mesh;
    const loose_element *element = &s->elements->items[index];
    for (uint32_t e = 0; !edge_is_point(mesh, element->edge) && e < mesh->edge_count; e++) {
        uint32_t object = cscd_mesh_vertex_object(mesh, mesh->edges[e][0]);
        if (!edge_is_loose(mesh, e) &&
            pair_filter_admits_objects(&s->interval->filter, element->object, object))
            test_ee(s->interval, element->edge, e, lane);
    }
    for (uint32_t i = index + 1; i < s->elements->count; i++) {
        const loose_element *other = &s->elements->items[i];
        if (pair_filter_admits_objects(&s->interval->filter, element->object, other->object) &&
            !edges_share_vertex(mesh->edges[element->edge], mesh->edges[other->edge]))
            test_ee(s->interval, element->edge, other->edge, lane);
    }
}

void loose_search_test_all(const loose_search *s, uint32_t lane_index, contact_lane *lane) {
    cscd_context *context = s->interval->mesh->context;
    for (uint32_t i = lane_index + (uint32_t)lane->cursor * s->lane_count;
         i < s->elements->count && !lane->out_of_memory; i += s->lane_count) {
        if (!progress_go_on(&context->progress, (double)i / s->elements->count)) break;
        test_triangles(s->interval, &s->elements->items[i], lane);
        test_edges(s, i, lane);
        if (contact_lane_suspend(lane, lane->cursor + 1)) return;
    }
}
