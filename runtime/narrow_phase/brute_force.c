/* Every pair of features that share no vertex: the reference that the other methods must equal. */
#include "runtime/narrow_phase/brute_force.h"

#include "runtime/narrow_phase/swept_box.h"

/* A vertex without a triangle is no feature of the surface. */
static bool in_surface(const cscd_mesh *mesh, uint32_t vertex) {
    return mesh->vertex_star_offsets[vertex + 1] > mesh->vertex_star_offsets[vertex];
}

static bool vertex_of_obstacle(const cscd_mesh *mesh, uint32_t vertex) {
    return triangle_of_obstacle(mesh, mesh->vertex_stars[mesh->vertex_star_offsets[vertex]]);
}

static bool edge_of_obstacle(const cscd_mesh *mesh, uint32_t edge) {
    return triangle_of_obstacle(mesh, mesh->edge_stars[mesh->edge_star_offsets[edge]]);
}

static void test_face(const swept_interval *interval, uint32_t triangle, contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    const uint32_t *corners = mesh->triangles[triangle];
    swept_box face = swept_box_of(interval, corners, 3);
    bool obstacle = triangle_of_obstacle(mesh, triangle);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (triangle_contains(corners, v) || !in_surface(mesh, v)) continue;
        if (obstacle && vertex_of_obstacle(mesh, v)) continue;
        lane->feature_pairs++;
        swept_box vertex = swept_box_of(interval, &v, 1);
        if (swept_boxes_within(&face, &vertex, interval->limit.distance))
            narrow_phase_test_vf(interval, v, triangle, lane);
    }
}

static void test_edge(const swept_interval *interval, uint32_t a, contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    const uint32_t *ends_a = mesh->edges[a];
    swept_box box_a = swept_box_of(interval, ends_a, 2);
    bool obstacle = edge_of_obstacle(mesh, a);
    for (uint32_t b = a + 1; b < mesh->edge_count; b++) {
        const uint32_t *ends_b = mesh->edges[b];
        if (edges_share_vertex(ends_a, ends_b) || (obstacle && edge_of_obstacle(mesh, b))) continue;
        lane->feature_pairs++;
        swept_box box_b = swept_box_of(interval, ends_b, 2);
        if (swept_boxes_within(&box_a, &box_b, interval->limit.distance))
            narrow_phase_test_ee(interval, a, b, lane);
    }
}

void brute_force_test(const swept_interval *interval, uint32_t lane_index, uint32_t lane_count,
                      contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    double rows = (double)mesh->triangle_count + mesh->edge_count;
    for (uint32_t t = lane_index; t < mesh->triangle_count && !lane->out_of_memory; t += lane_count) {
        if (!progress_go_on(&mesh->context->progress, t / rows)) break;
        test_face(interval, t, lane);
    }
    for (uint32_t e = lane_index; e < mesh->edge_count && !lane->out_of_memory; e += lane_count) {
        if (!progress_go_on(&mesh->context->progress, ((double)mesh->triangle_count + e) / rows)) break;
        test_edge(interval, e, lane);
    }
    narrow_phase_finish(interval, lane);
}
