/* Where pairs of adjacent triangles are skipped, exactly one pair of triangles that share no vertex tests each
 * pair of features that share none; or the pair of features is an orphan pair. */
#include "runtime/narrow_phase/narrow_phase.h"
#include "runtime/narrow_phase/narrow_phase_kernels.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { TRIANGLES_MAX = 120, VERTICES_MAX = 130, FAN = 64, SMALL_SEEDS = 20, LARGE_SEEDS = 2 };

/* How many pairs of triangles test a pair of features: vertex v and triangle t, edges a and b. */
static uint8_t vf[SCENE_VERTICES_MAX * SCENE_TRIANGLES_MAX];
static uint8_t ee[SCENE_TRIANGLES_MAX * 3 * SCENE_TRIANGLES_MAX * 3];

/* Pairs of triangles that are known to be far from each other on the surface. */
static size_t settled_pairs;

static uint8_t *count_of_vf(const cscd_mesh *mesh, uint32_t vertex, uint32_t triangle) {
    return &vf[(size_t)vertex * mesh->triangle_count + triangle];
}

static uint8_t *count_of_ee(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    return &ee[(size_t)(a < b ? a : b) * mesh->edge_count + (a < b ? b : a)];
}

/* Adds 1 to a count if the bit of a set of features is there. */
static void count_bit(uint8_t *count, uint32_t features, int bit) {
    if ((features >> bit & 1) != 0) (*count)++;
}

static void count_pair(const swept_interval *interval, triangle_pair pair) {
    const cscd_mesh *mesh = interval->mesh;
    pair_selection early = representatives_select_early(interval, pair);
    uint16_t tested = early.features;
    if (!early.settled) representatives_select(interval, &pair, 1, &tested);
    settled_pairs += early.settled;
    for (int i = 0; i < 3; i++) {
        count_bit(count_of_vf(mesh, mesh->triangles[pair.a][i], pair.b), tested, i);
        count_bit(count_of_vf(mesh, mesh->triangles[pair.b][i], pair.a), tested, FEATURE_VERTEX_B + i);
    }
    for (int i = 0; i < 9; i++) {
        uint32_t a = mesh->triangle_edges[pair.a][i / 3], b = mesh->triangle_edges[pair.b][i % 3];
        count_bit(count_of_ee(mesh, a, b), tested, FEATURE_EDGES + i);
    }
}

/* Returns the number of orphan pairs. */
static size_t check_mesh(const cscd_mesh *mesh) {
    representatives r;
    orphan_pairs orphans;
    bool too_many;
    memset(vf, 0, (size_t)mesh->vertex_count * mesh->triangle_count);
    memset(ee, 0, (size_t)mesh->edge_count * mesh->edge_count);
    assert_int_equal(representatives_create(mesh, &r), CSCD_OK);
    assert_int_equal(orphan_pairs_create(mesh, &orphans, &too_many), CSCD_OK);
    size_t count = orphans.vf_count + orphans.ee_count;
    /* also where components may be culled, but none is */
    const culling flags = {.region_count = 0};
    bool *culled = calloc(mesh->component_count, sizeof *culled);
    assert_non_null(culled);
    swept_interval interval = {.mesh = mesh, .representatives = &r, .skip_adjacent = true, .culled = culled};
    for (uint32_t a = 0; !too_many && a < mesh->triangle_count; a++) {
        for (uint32_t b = a + 1; b < mesh->triangle_count; b++) {
            bool swapped = (a + b) % 2 == 1;
            interval.culling = a % 2 == 0 ? &flags : NULL;
            if (!triangles_share_vertex(mesh->triangles[a], mesh->triangles[b]))
                count_pair(&interval, swapped ? (triangle_pair){b, a} : (triangle_pair){a, b});
        }
    }
    for (size_t i = 0; i < orphans.vf_count; i++) (*count_of_vf(mesh, orphans.vf[i][0], orphans.vf[i][1]))++;
    for (size_t i = 0; i < orphans.ee_count; i++) (*count_of_ee(mesh, orphans.ee[i][0], orphans.ee[i][1]))++;
    for (uint32_t t = 0; !too_many && t < mesh->triangle_count; t++) {
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            bool used = mesh->vertex_star_offsets[v + 1] > mesh->vertex_star_offsets[v];
            assert_int_equal(*count_of_vf(mesh, v, t), used && !triangle_contains(mesh->triangles[t], v));
        }
    }
    for (uint32_t a = 0; !too_many && a < mesh->edge_count; a++) {
        for (uint32_t b = a + 1; b < mesh->edge_count; b++)
            assert_int_equal(*count_of_ee(mesh, a, b), !edges_share_vertex(mesh->edges[a], mesh->edges[b]));
    }
    free(culled);
    representatives_free(mesh->context, &r);
    orphan_pairs_free(mesh->context, &orphans);
    return count;
}

static size_t check_triangles(cscd_context *context, uint32_t vertex_count, uint32_t count,
                              const uint32_t (*triangles)[3]) {
    const cscd_object_desc desc = cscd_object_of_triangles(vertex_count, count, triangles[0]);
    cscd_mesh *mesh = NULL;
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    size_t orphans = check_mesh(mesh);
    cscd_mesh_destroy(mesh);
    return orphans;
}

/* Few vertices, so that edges have many triangles and triangles come twice. */
TEST(any_triangles) {
    cscd_context *context = NULL;
    random_stream random = stream_start(5);
    size_t orphans = 0;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    for (int round = 0; round < 200; round++) {
        uint32_t triangles[TRIANGLES_MAX][3], count = 1 + stream_below(&random, TRIANGLES_MAX);
        uint32_t vertices = 4 + stream_below(&random, VERTICES_MAX - 4);
        for (uint32_t t = 0; t < count; t++) {
            uint32_t *v = triangles[t];
            do {
                for (int i = 0; i < 3; i++) v[i] = stream_below(&random, vertices);
            } while (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]);
        }
        orphans += check_triangles(context, vertices, count, (const uint32_t(*)[3])triangles);
    }
    assert_true(orphans > 1000);
    cscd_context_destroy(context);
}

/* Large ones with few seeds: their seeds move vertices, and the triangles stay the same. */
TEST(all_scenes) {
    static scene s;
    cscd_context *context = NULL;
    settled_pairs = 0;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        bool small = true;
        for (uint64_t seed = 0; seed < (small ? SMALL_SEEDS : LARGE_SEEDS); seed++) {
            scene_make((scene_family)family, seed, &s);
            small = s.triangle_count <= TRIANGLES_MAX;
            check_triangles(context, s.vertex_count, s.triangle_count, (const uint32_t(*)[3])s.triangles);
        }
    }
    print_message("%zu pairs of triangles are settled early\n", settled_pairs);
    assert_true(settled_pairs > 50000);
    cscd_context_destroy(context);
}

/* All triangles of a fan are adjacent: its orphan pairs grow with the square. */
TEST(fans_have_too_many) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    uint32_t triangles[FAN][3];
    for (uint32_t t = 0; t < FAN; t++) {
        triangles[t][0] = 0;
        triangles[t][1] = 1 + t;
        triangles[t][2] = 2 + t;
    }
    const cscd_object_desc desc = cscd_object_of_triangles(FAN + 2, FAN, triangles[0]);
    orphan_pairs orphans;
    bool too_many = false;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(orphan_pairs_create(mesh, &orphans, &too_many), CSCD_OK);
    assert_true(too_many && orphans.vf_count == 0 && orphans.ee_count == 0);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}
