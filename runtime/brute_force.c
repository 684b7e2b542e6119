/* Every pair of features that share no vertex: the reference that the other methods must equal. */
#include "runtime/brute_force.h"

#include <math.h>

typedef struct swept_box {
    double low[3], high[3];
} swept_box;

static void add_vertex(const swept_interval *interval, uint32_t vertex, swept_box *box) {
    for (int k = 0; k < 3; k++) {
        double start = interval->x0[(size_t)vertex * 3 + (size_t)k];
        double end = interval->x1[(size_t)vertex * 3 + (size_t)k];
        double low = start < end ? start : end, high = start < end ? end : start;
        box->low[k] = low < box->low[k] ? low : box->low[k];
        box->high[k] = high > box->high[k] ? high : box->high[k];
    }
}

static swept_box feature_box(const swept_interval *interval, const uint32_t *vertices, int count) {
    swept_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < count; i++) add_vertex(interval, vertices[i], &box);
    return box;
}

/* Rounding is monotone, so a gap of no more than the distance is never found to be more: nothing needs to be
 * rounded outward here. */
static bool boxes_within(const swept_box *a, const swept_box *b, double distance) {
    for (int k = 0; k < 3; k++) {
        if (b->low[k] - a->high[k] > distance || a->low[k] - b->high[k] > distance) return false;
    }
    return true;
}

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
    swept_box face = feature_box(interval, corners, 3);
    bool obstacle = triangle_of_obstacle(mesh, triangle);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (triangle_contains(corners, v) || !in_surface(mesh, v)) continue;
        if (obstacle && vertex_of_obstacle(mesh, v)) continue;
        lane->feature_pairs++;
        swept_box vertex = feature_box(interval, &v, 1);
        if (boxes_within(&face, &vertex, interval->limit.distance))
            narrow_phase_test_vf(interval, v, triangle, lane);
    }
}

static void test_edge(const swept_interval *interval, uint32_t a, contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    const uint32_t *ends_a = mesh->edges[a];
    swept_box box_a = feature_box(interval, ends_a, 2);
    bool obstacle = edge_of_obstacle(mesh, a);
    for (uint32_t b = a + 1; b < mesh->edge_count; b++) {
        const uint32_t *ends_b = mesh->edges[b];
        if (edges_share_vertex(ends_a, ends_b) || (obstacle && edge_of_obstacle(mesh, b))) continue;
        lane->feature_pairs++;
        swept_box box_b = feature_box(interval, ends_b, 2);
        if (boxes_within(&box_a, &box_b, interval->limit.distance))
            narrow_phase_test_ee(interval, a, b, lane);
    }
}

void brute_force_test(const swept_interval *interval, uint32_t lane_index, uint32_t lane_count,
                      contact_lane *lane) {
    const cscd_mesh *mesh = interval->mesh;
    for (uint32_t t = lane_index; t < mesh->triangle_count && !lane->out_of_memory; t += lane_count)
        test_face(interval, t, lane);
    for (uint32_t e = lane_index; e < mesh->edge_count && !lane->out_of_memory; e += lane_count)
        test_edge(interval, e, lane);
    narrow_phase_finish(interval, lane);
}
