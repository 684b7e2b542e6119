/* Equalized densities are ranks, by component; low ones form edge-connected clusters. */
#include "preprocess/regions/clusters.h"
#include "preprocess/regions/equalize.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/random.h"
#include "tests/support/refusal.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static cscd_context *context;
static size_t bytes_at_start;

static int open_context(void **state) {
    (void)state;
    if (cscd_context_create(NULL, &context) != CSCD_OK) return -1;
    bytes_at_start = cscd_context_bytes(context);
    return 0;
}

static int close_context(void **state) {
    (void)state;
    bool leaked = cscd_context_bytes(context) != bytes_at_start;
    cscd_context_destroy(context);
    return leaked ? -1 : 0;
}

static cscd_mesh *mesh_of(const shape *s) {
    cscd_mesh *mesh = NULL;
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles[0]);
    expect_ok(cscd_mesh_create(context, &desc, 1, &mesh));
    return mesh;
}

/* Triangle i is joined to i - 1 and i + 1. */
static cscd_mesh *strip_mesh(uint32_t triangle_count) {
    shape s = {0};
    for (uint32_t i = 0; i < triangle_count; i++)
        shape_add_triangle(&s, i, i % 2 == 0 ? i + 1 : i + 2, i % 2 == 0 ? i + 2 : i + 1);
    return mesh_of(&s);
}

static void assert_doubles(const double *found, const double *expected, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) assert_true(found[i] == expected[i]);
}

TEST(ranks_of_densities) {
    cscd_mesh *mesh = strip_mesh(8);
    const double density[8] = {3.0, -0.5, 1e300, -1e-300, 0.0, -1e300, 1e-320, 2.0};
    const double expected[8] = {7 / 8.0, 2 / 8.0, 8 / 8.0, 3 / 8.0, 4 / 8.0, 1 / 8.0, 5 / 8.0, 6 / 8.0};
    double found[8];
    expect_ok(equalize(mesh, density, false, found));
    assert_doubles(found, expected, 8);
    cscd_mesh_destroy(mesh);
}

TEST(ties_go_by_index) {
    cscd_mesh *mesh = strip_mesh(6);
    double found[6];
    const double same[6] = {1, 1, 1, 1, 1, 1}, zeros[6] = {0.0, -0.0, 1.0, 0.0, -1.0, -0.0};
    const double ascending[6] = {1 / 6.0, 2 / 6.0, 3 / 6.0, 4 / 6.0, 5 / 6.0, 6 / 6.0};
    const double of_zeros[6] = {2 / 6.0, 3 / 6.0, 6 / 6.0, 4 / 6.0, 1 / 6.0, 5 / 6.0};
    expect_ok(equalize(mesh, same, false, found));
    assert_doubles(found, ascending, 6);
    expect_ok(equalize(mesh, zeros, false, found));
    assert_doubles(found, of_zeros, 6);
    cscd_mesh_destroy(mesh);
}

/* Noise beyond 24 bits does not change the order; a difference in the 23rd bit does. */
TEST(rounded_to_24_bits) {
    cscd_mesh *mesh = strip_mesh(3);
    double found[3];
    for (int exponent = -1000; exponent <= 1000; exponent += 100) {
        double unit = ldexp(1.0, exponent);
        const double noisy[3] = {unit * (1 + 0x1p-40), unit, unit * (1 + 0x1p-30)};
        const double clear[3] = {unit * (1 + 0x1p-22), unit, unit * (1 + 0x1p-23)};
        const double by_index[3] = {1 / 3.0, 2 / 3.0, 1.0}, by_value[3] = {1.0, 1 / 3.0, 2 / 3.0};
        expect_ok(equalize(mesh, noisy, false, found));
        assert_doubles(found, by_index, 3);
        expect_ok(equalize(mesh, clear, false, found));
        assert_doubles(found, by_value, 3);
    }
    cscd_mesh_destroy(mesh);
}

/* An inner component with hardly any charge is not all low, nor does it change the outer one's ranks. */
TEST(each_component_on_its_own) {
    shape s = {0};
    shape_add_tetrahedron(&s, 0, 1, 2, 3);
    shape_add_tetrahedron(&s, 4, 5, 6, 7);
    cscd_mesh *mesh = mesh_of(&s);
    const double density[2][8] = {
        {4, 3, 2, 1, 1e-9, 2e-9, -1e-9, 3e-9},
        {4, 3, 2, 1, 1.5, 2.5, -1e-9, 3.5}}; /* far from those of the other, and among them */
    const double expected[8] = {1.0, 0.75, 0.5, 0.25, 0.5, 0.75, 0.25, 1.0};
    for (int i = 0; i < 2; i++) {
        double found[8];
        expect_ok(equalize(mesh, density[i], false, found));
        assert_doubles(found, expected, 8);
    }
    cscd_mesh_destroy(mesh);
}

/* Counts equation 3.18 naively. */
TEST(published_bins) {
    enum { COUNT = 200 };
    cscd_mesh *mesh = strip_mesh(COUNT);
    double density[COUNT], found[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) density[i] = random_integer(-20, 300);
    density[7] = -20.0;
    density[70] = 300.0;
    density[71] = 299.0; /* the last bin has others than the highest */
    expect_ok(equalize(mesh, density, true, found));
    for (uint32_t i = 0; i < COUNT; i++) {
        double bin = fmin(floor((density[i] + 20.0) / 320.0 * 256.0), 255.0), below = 0.0;
        for (uint32_t j = 0; j < COUNT; j++)
            below += fmin(floor((density[j] + 20.0) / 320.0 * 256.0), 255.0) <= bin;
        assert_true(found[i] == below / COUNT);
    }
    for (uint32_t i = 0; i < COUNT; i++) density[i] = 5.0;
    expect_ok(equalize(mesh, density, true, found));
    for (uint32_t i = 0; i < COUNT; i++) assert_true(found[i] == 1.0);
    density[3] = -1.7e308;
    density[4] = 1.7e308;
    expect_ok(equalize(mesh, density, true, found));
    assert_true(found[3] == 1.0 / COUNT && found[4] == 1.0 && found[5] == (COUNT - 1.0) / COUNT);
    cscd_mesh_destroy(mesh);
}

TEST(not_finite_is_refused) {
    cscd_mesh *mesh = strip_mesh(4);
    const double bad[3] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        double density[4] = {1, 2, bad[i], 4}, found[4] = {-7, -7, -7, -7};
        expect_invalid(context, equalize(mesh, density, i == 1, found), "triangle 2");
        for (int j = 0; j < 4; j++) assert_true(found[j] == -7);
    }
    cscd_mesh_destroy(mesh);
}

/* members: each cluster's triangles, in any order. */
static void assert_clusters(const cscd_mesh *mesh, const double *equalized, double threshold, uint32_t count,
                            const uint32_t *offsets, const uint32_t *members) {
    dual_graph graph;
    clusters found;
    expect_ok(dual_graph_build(mesh, &graph));
    expect_ok(clusters_find(mesh, &graph, equalized, threshold, &found));
    assert_int_equal(found.count, count);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(found.offsets[i + 1], offsets[i + 1]);
        for (uint32_t j = offsets[i]; j < offsets[i + 1]; j++) {
            bool there = false;
            for (uint32_t k = offsets[i]; k < offsets[i + 1]; k++) there |= found.triangles[k] == members[j];
            assert_true(there);
        }
    }
    clusters_free(mesh, &found);
    dual_graph_free(mesh, &graph);
}

TEST(clusters_on_a_strip) {
    cscd_mesh *mesh = strip_mesh(10);
    const double equalized[10] = {0.1, 0.3, 0.2, 0.2, 0.9, 0.2, 0.8, 0.21, 0.1, 0.1};
    assert_clusters(mesh, equalized, 0.2, 4, (uint32_t[]){0, 1, 3, 4, 6}, (uint32_t[]){0, 2, 3, 5, 8, 9});
    assert_clusters(mesh, equalized, 0.05, 0, (uint32_t[]){0}, NULL);
    assert_clusters(mesh, equalized, 1.0, 1, (uint32_t[]){0, 10}, (uint32_t[]){0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    cscd_mesh_destroy(mesh);
}

/* Obstacles are not cut, so none of their triangles is in a cluster. */
TEST(obstacles_have_no_clusters) {
    const uint32_t triangles[6] = {0, 1, 2, 1, 3, 2}, members[2][2] = {{2, 3}, {0, 1}};
    const double low[4] = {0.1, 0.1, 0.1, 0.1};
    for (int second = 0; second < 2; second++) {
        cscd_object_desc descs[2] = {cscd_object_of_triangles(4, 2, triangles),
                                     cscd_object_of_triangles(4, 2, triangles)};
        cscd_mesh *mesh = NULL;
        descs[second].obstacle = true;
        assert_int_equal(cscd_mesh_create(context, descs, 2, &mesh), CSCD_OK);
        assert_clusters(mesh, low, 0.1, 1, (uint32_t[]){0, 2}, members[second]);
        cscd_mesh_destroy(mesh);
    }
}

/* Triangles that share only a vertex are two clusters, the three of one edge are one. */
TEST(edges_join_clusters) {
    const double low[6] = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1};
    shape bow_tie = {0}, fin = {0};
    shape_add_triangle(&bow_tie, 0, 1, 2);
    shape_add_triangle(&bow_tie, 2, 3, 4);
    cscd_mesh *mesh = mesh_of(&bow_tie);
    assert_clusters(mesh, low, 0.1, 2, (uint32_t[]){0, 1, 2}, (uint32_t[]){0, 1});
    cscd_mesh_destroy(mesh);
    for (uint32_t i = 0; i < 3; i++) shape_add_triangle(&fin, 0, 1, 2 + i);
    mesh = mesh_of(&fin);
    assert_clusters(mesh, low, 0.1, 1, (uint32_t[]){0, 3}, (uint32_t[]){0, 1, 2});
    cscd_mesh_destroy(mesh);
}

AROUND_ALL(open_context, close_context)
