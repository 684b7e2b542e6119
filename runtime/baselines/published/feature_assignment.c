/* From pairs of triangles to pairs of features, each of which is tested once (Yeh 2012, section 4.6; Tang et al. 2009). */
#include "runtime/baselines/published/feature_assignment.h"

#include "cscd/research.h"

/* The oneRingList of a feature: the triangles that contain it. */
typedef struct one_ring {
    const uint32_t *triangles;
    uint32_t count;
} one_ring;

static one_ring ring_of_vertex(const cscd_mesh *mesh, uint32_t v) {
    const uint32_t first = mesh->vertex_star_offsets[v];
    return (one_ring){mesh->vertex_stars + first, mesh->vertex_star_offsets[v + 1] - first};
}

static one_ring ring_of_edge(const cscd_mesh *mesh, uint32_t e) {
    const uint32_t first = mesh->edge_star_offsets[e];
    return (one_ring){mesh->edge_stars + first, mesh->edge_star_offsets[e + 1] - first};
}

static bool share_vertex(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    for (int i = 0; i < 3; i++)
        if (triangle_contains(mesh->triangles[b], mesh->triangles[a][i])) return true;
    return false;
}

/* Does the search list this pair, if its volumes overlap? */
static bool is_looked_at(const own_interval *interval, uint32_t a, uint32_t b) {
    const bool adjacent =
        (interval->ours & CSCD_OURS_NEIGHBOURS) == 0 && share_vertex(interval->swept->mesh, a, b);
    return !adjacent && culling_keeps(interval->culling, a, b);
}

/* Is (a, b) the first of the pairs of two rings, in their order, that is looked at? */
static bool is_first(const own_interval *interval, one_ring of_a, one_ring of_b, uint32_t a, uint32_t b) {
    for (uint32_t i = 0; i < of_a.count; i++) {
        for (uint32_t j = 0; j < of_b.count; j++) {
            if (of_a.triangles[i] == a && of_b.triangles[j] == b) return true;
            if (is_looked_at(interval, of_a.triangles[i], of_b.triangles[j])) return false;
        }
    }
    return false;
}

static bool is_assigned(const own_interval *interval, one_ring of_a, one_ring of_b, uint32_t a, uint32_t b) {
    if ((interval->ours & CSCD_OURS_REPRESENTATIVES) != 0) return is_first(interval, of_a, of_b, a, b);
    return of_a.triangles[0] == a && of_b.triangles[0] == b;
}

static void test_vertices(const own_interval *interval, uint32_t a, uint32_t b, feature_test *test,
                          void *data) {
    const cscd_mesh *mesh = interval->swept->mesh;
    const one_ring face = {&b, 1};
    for (int i = 0; i < 3; i++) {
        const uint32_t v = mesh->triangles[a][i];
        if (!triangle_contains(mesh->triangles[b], v) &&
            is_assigned(interval, ring_of_vertex(mesh, v), face, a, b))
            test(data, CSCD_CONTACT_VF, v, b);
    }
}

static void test_edges(const own_interval *interval, uint32_t a, uint32_t b, feature_test *test, void *data) {
    const cscd_mesh *mesh = interval->swept->mesh;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const uint32_t e = mesh->triangle_edges[a][i], f = mesh->triangle_edges[b][j];
            if (edges_share_vertex(mesh->edges[e], mesh->edges[f])) continue;
            const bool ascending = e < f; /* one order of the pairs, whichever triangle comes first */
            const one_ring of_e = ring_of_edge(mesh, e), of_f = ring_of_edge(mesh, f);
            if (ascending ? is_assigned(interval, of_e, of_f, a, b) : is_assigned(interval, of_f, of_e, b, a))
                test(data, CSCD_CONTACT_EE, ascending ? e : f, ascending ? f : e);
        }
    }
}

void feature_assignment_test(const own_interval *interval, uint32_t a, uint32_t b, feature_test *test,
                             void *data) {
    test_vertices(interval, a, b, test, data);
    test_vertices(interval, b, a, test, data);
    test_edges(interval, a, b, test, data);
}
