/* K-means regions: centroids of the vertices, triangles by fewest edges; the same for the same seed. */
#include "preprocess/regions/regions.h"
#include "tests/support/models/bodies.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { TRIANGLES_MAX = 4000, REGIONS_MAX = 4000 };

typedef struct kmeans_division {
    uint32_t count, regions[TRIANGLES_MAX];
    double points[REGIONS_MAX * 3];
} kmeans_division;

static kmeans_division found, other;

static void divide_body(const body *b, uint32_t k, uint32_t seed, kmeans_division *out) {
    cscd_mesh *mesh = body_mesh(b, 1);
    size_t bytes = cscd_context_describe(mesh->context).bytes;
    memset(out, 0xff, sizeof *out);
    assert_true(b->triangle_count <= TRIANGLES_MAX && kmeans_capacity(mesh, k) <= REGIONS_MAX);
    expect_ok(regions_kmeans(mesh, b->positions, k, seed, out->regions, &out->count, out->points));
    assert_int_equal(cscd_context_describe(mesh->context).bytes, bytes);
    assert_true(out->count <= kmeans_capacity(mesh, k));
    check_regions(mesh, out->regions, out->count);
    for (uint32_t i = 0; i < out->count * 3; i++) assert_true(isfinite(out->points[i]));
    body_mesh_destroy(mesh);
}

static void assert_same(const kmeans_division *a, const kmeans_division *b) {
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->regions, b->regions, sizeof a->regions);
    assert_memory_equal(a->points, b->points, a->count * 3 * sizeof(double));
}

TEST(one_is_the_mean) {
    body b = body_of(BODY_PAWN, 1500);
    double mean[3] = {0, 0, 0};
    for (uint32_t i = 0; i < b.vertex_count * 3; i++) mean[i % 3] += b.positions[i] / b.vertex_count;
    body_add_vertex(&b, 1e6, 0, 0); /* without a triangle: it does not count */
    divide_body(&b, 1, 5, &found);
    assert_int_equal(found.count, 1);
    for (int k = 0; k < 3; k++) assert_true(fabs(found.points[k] - mean[k]) < 1e-12);
    body_free(&b);
}

/* Two well separated clusters are found from any start. */
TEST(two_balls) {
    body b = body_of(BODY_DUMBBELL, 2000);
    for (uint32_t seed = 0; seed < 20; seed++) {
        divide_body(&b, 2, seed, &found);
        assert_int_equal(found.count, 2);
        for (uint32_t t = 0; t < b.triangle_count; t++) {
            double z = b.positions[b.triangles[t * 3] * 3 + 2];
            if (fabs(z) > 0.7) assert_true(z * found.points[found.regions[t] * 3 + 2] > 0.0);
        }
    }
    body_free(&b);
}

TEST(different_seeds) {
    body b = body_of(BODY_FIGURE, 2000);
    bool differ = false;
    for (uint32_t k = 2; k <= 9; k++) {
        divide_body(&b, k, 7, &found);
        assert_int_equal(found.count, k);
        divide_body(&b, k, 7, &other);
        assert_same(&found, &other);
        divide_body(&b, k, 8, &other);
        differ = differ || memcmp(found.regions, other.regions, sizeof found.regions) != 0;
    }
    assert_true(differ);
    body_free(&b);
}

/* Each component gets at least one region and shares the others by its vertices; no region spans two
 * components. */
TEST(components_share_k) {
    body b = body_of(BODY_SPHERE, 2000), small = {0};
    for (int i = 0; i < 4; i++) body_add_vertex(&small, i == 1, i == 2, i == 3);
    body_add_triangle(&small, 0, 2, 1);
    body_add_triangle(&small, 0, 1, 3);
    body_add_triangle(&small, 0, 3, 2);
    body_add_triangle(&small, 1, 2, 3);
    uint32_t ball = b.triangle_count;
    for (int i = 0; i < 3; i++) body_append(&b, &small, (double[3]){3.0 + i, 0, 0});
    for (uint32_t k = 1; k <= 12; k++) {
        divide_body(&b, k, k, &found);
        assert_int_equal(found.count, k < 4 ? 4 : k);
        for (uint32_t i = 0; i < 3; i++) assert_int_equal(found.regions[ball + i * 4], found.count - 3 + i);
    }
    body_free(&small);
    body_free(&b);
}

/* Even with as many centroids as vertices, or more, there are no more regions than fit, and each is
 * connected. */
TEST(more_than_vertices) {
    body b = body_of(BODY_DUMBBELL, 1500);
    const uint32_t ks[] = {100,     500,       750, b.vertex_count - 1, b.vertex_count, b.vertex_count + 1,
                           1000000, UINT32_MAX};
    for (size_t i = 0; i < sizeof ks / sizeof *ks; i++) {
        divide_body(&b, ks[i], 3, &found);
        assert_true(found.count >= (ks[i] < 500 ? ks[i] * 9 / 10 : 300));
    }
    body_free(&b);
}

/* Counts the edges on the shortest path from a vertex to every other one. */
static void measure_steps(const body *b, uint32_t from, uint32_t *distances) {
    for (uint32_t v = 0; v < b->vertex_count; v++) distances[v] = v == from ? 0 : UINT32_MAX - 1;
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t c = 0; c < b->triangle_count * 3; c++) {
            uint32_t v = b->triangles[c], w = b->triangles[c % 3 == 2 ? c - 2 : c + 1];
            if (distances[v] + 1 < distances[w]) distances[w] = distances[v] + 1, changed = true;
            if (distances[w] + 1 < distances[v]) distances[v] = distances[w] + 1, changed = true;
        }
    }
}

/* The vertex nearest to a detector point: its anchor, where the clusters are compact. */
static uint32_t nearest_vertex(const body *b, const double *point) {
    uint32_t nearest = 0;
    double least = INFINITY;
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        const double *p = b->positions + (size_t)v * 3;
        double distance = hypot(hypot(p[0] - point[0], p[1] - point[1]), p[2] - point[2]);
        if (distance >= least) continue;
        least = distance;
        nearest = v;
    }
    return nearest;
}

/* Each triangle belongs to a detector point that is fewest edges away, except the few that joined a
 * neighbour. */
TEST(fewest_edges) {
    enum { K = 5 };
    static uint32_t distances[K][TRIANGLES_MAX];
    body b = body_of(BODY_SPHERE, 1500);
    divide_body(&b, K, 11, &found);
    assert_int_equal(found.count, K);
    for (uint32_t r = 0; r < K; r++)
        measure_steps(&b, nearest_vertex(&b, found.points + (size_t)r * 3), distances[r]);
    uint32_t farther = 0;
    for (uint32_t t = 0; t < b.triangle_count; t++) {
        uint32_t own = UINT32_MAX, least = UINT32_MAX;
        for (uint32_t r = 0; r < K; r++) {
            for (uint32_t i = 0; i < 3; i++) {
                uint32_t d = distances[r][b.triangles[t * 3 + i]];
                if (r == found.regions[t] && d < own) own = d;
                if (d < least) least = d;
            }
        }
        farther += own > least;
    }
    assert_true(farther <= b.triangle_count / 100);
    body_free(&b);
}

TEST(lloyd_on_a_line) {
    double positions[12 * 3] = {0};
    uint32_t points[10], clusters[12], scratch[10];
    for (uint32_t i = 0; i < 12; i++) positions[i * 3] = i < 5 ? i : i < 10 ? 100.0 + i : 1e9;
    for (uint32_t i = 0; i < 10; i++) points[i] = i;
    cscd_context *context = NULL;
    expect_ok(cscd_context_create(NULL, &context));
    for (uint64_t seed = 0; seed < 50; seed++) {
        double centroids[6];
        uint64_t counts[2];
        memset(clusters, 0xff, sizeof clusters);
        lloyd l = {context, positions, points, 10, 2, centroids, clusters, counts, scratch};
        expect_ok(lloyd_run(&l, seed));
        uint32_t low = centroids[0] < centroids[3] ? 0 : 1;
        assert_true(centroids[low * 3] == 2.0 && centroids[3 - low * 3] == 107.0);
        for (uint32_t i = 0; i < 12; i++)
            assert_int_equal(clusters[i], i < 5 ? low : i < 10 ? 1 - low : UINT32_MAX);
    }
    cscd_context_destroy(context);
}

/* 3 is as near to the mean of the two 0 and itself as to 5: it belongs to the first of the two, and stays only there. */
TEST(equally_near_centroids) {
    static const double line[6] = {0, 0, 3, 5, 5, 5};
    double positions[18] = {0};
    uint32_t points[6], clusters[6], scratch[6], stayed = 0;
    cscd_context *context = NULL;
    for (uint32_t i = 0; i < 6; i++) positions[3 * (points[i] = i)] = line[i];
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    for (uint64_t seed = 0; seed < 50; seed++) {
        double centroids[6];
        uint64_t counts[2];
        memset(clusters, 0xff, sizeof clusters);
        lloyd l = {context, positions, points, 6, 2, centroids, clusters, counts, scratch};
        assert_int_equal(lloyd_run(&l, seed), CSCD_OK);
        assert_true(centroids[3] != 1.0);
        stayed += centroids[0] == 1.0;
    }
    assert_true(stayed > 0);
    cscd_context_destroy(context);
}

TEST(zero_is_refused) {
    body b = body_of(BODY_SPHERE, 1500);
    cscd_mesh *mesh = body_mesh(&b, 1);
    uint32_t count = 77;
    assert_int_equal(regions_kmeans(mesh, b.positions, 0, 1, found.regions, &count, found.points),
                     CSCD_INVALID_ARGUMENT);
    assert_int_equal(count, 77);
    body_mesh_destroy(mesh);
    body_free(&b);
}
