/* Every pair of features of triangles that share no vertex: the reference that the other methods must equal. */
#include "runtime/narrow_phase/narrow_phase.h"

static void test_face(const swept_interval *interval, uint32_t triangle, contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    const uint32_t *corners = mesh->triangles[triangle];
    swept_box face = swept_box_of(interval, corners, 3);
    uint32_t component = mesh->triangle_components[triangle];
    bool all = pair_filter_admits_all(&interval->filter, component);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (triangle_contains(corners, v) || vertex_has_no_triangle(mesh, v)) continue;
        if (!all && !pair_filter_admits_components(&interval->filter, component, vertex_component(mesh, v)))
            continue;
        if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_VF, v, triangle)) continue;
        worker->feature_pairs++;
        swept_box vertex = swept_box_of(interval, &v, 1);
        if (swept_boxes_within(&face, &vertex, pair_reach(interval, CSCD_CONTACT_VF, v, triangle)))
            narrow_phase_test_vf(interval, v, triangle, worker);
    }
}

static void test_edge(const swept_interval *interval, uint32_t a, contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    const uint32_t *ends_a = mesh->edges[a];
    if (edge_is_loose(mesh, a)) return;
    swept_box box_a = swept_box_of(interval, ends_a, 2);
    uint32_t component = edge_component(mesh, a);
    bool all = pair_filter_admits_all(&interval->filter, component);
    for (uint32_t b = a + 1; b < mesh->edge_count; b++) {
        const uint32_t *ends_b = mesh->edges[b];
        if (edges_share_vertex(ends_a, ends_b) || edge_is_loose(mesh, b)) continue;
        if (!all && !pair_filter_admits_components(&interval->filter, component, edge_component(mesh, b)))
            continue;
        if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_EE, a, b)) continue;
        worker->feature_pairs++;
        swept_box box_b = swept_box_of(interval, ends_b, 2);
        if (swept_boxes_within(&box_a, &box_b, pair_reach(interval, CSCD_CONTACT_EE, a, b)))
            narrow_phase_test_ee(interval, a, b, worker);
    }
}

/* A row is a triangle with all vertices, or an edge with all edges behind it. The cursor is that of the
 * worker's rows. */
void brute_force_test(const swept_interval *interval, uint32_t worker_index, uint32_t worker_count,
                      contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    uint64_t rows = (uint64_t)mesh->triangle_count + mesh->edge_count;
    worker->suspended = false;
    for (uint64_t row = worker_index + worker->cursor * worker_count; row < rows && !worker->out_of_memory;
         row += worker_count) {
        if (!progress_go_on(&mesh->context->progress, (double)row / (double)rows)) break;
        if (row < mesh->triangle_count)
            test_face(interval, (uint32_t)row, worker);
        else
            test_edge(interval, (uint32_t)(row - mesh->triangle_count), worker);
        if (contact_worker_suspend(worker, worker->cursor + 1)) return;
    }
    narrow_phase_finish(interval, worker);
}
