/* Orphan pairs are those of their definition, on small surfaces whose vertices have few triangles, with boundaries and with edges of
 * more than two triangles. */
#include "runtime/narrow_phase/narrow_phase.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { SURFACES = 4000, TRIANGLES_MAX = 200, VERTICES_MAX = 100 };

/* Surfaces need no positions. */
typedef struct small_surface {
    uint32_t triangles[TRIANGLES_MAX][3], triangle_count, vertex_count;
} small_surface;

static small_surface s;

static void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t corners[3] = {a, b, c};
    if (s.triangle_count < TRIANGLES_MAX) memcpy(s.triangles[s.triangle_count++], corners, sizeof corners);
}

/* A torus of rows times columns squares; with few of them, vertices that are not neighbours are joined by edges. */
static void make_torus(uint32_t rows, uint32_t columns) {
    s = (small_surface){.vertex_count = rows * columns};
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            uint32_t next_row = (i + 1) % rows * columns, next = (j + 1) % columns, row = i * columns;
            add_triangle(row + j, next_row + j, next_row + next);
            add_triangle(row + j, next_row + next, row + next);
        }
    }
}

/* Two tips over a ring: a tetrahedron has ring 3 and one tip less, an octahedron ring 4. */
static void make_bipyramid(uint32_t ring) {
    s = (small_surface){.vertex_count = ring + 2};
    for (uint32_t i = 0; i < ring; i++) {
        add_triangle(ring, i, (i + 1) % ring);
        add_triangle(ring + 1, (i + 1) % ring, i);
    }
}

/* The least closed surface, and two triangles on the same three vertices. */
static void make_least(bool flat) {
    s = (small_surface){.vertex_count = 4};
    add_triangle(0, 1, 2);
    add_triangle(0, 2, flat ? 1 : 3);
    for (uint32_t i = 0; !flat && i < 2; i++) add_triangle(3, i + 1, i);
}

static bool has_corner(const uint32_t t[3], uint32_t v) {
    return t[0] == v || t[1] == v || t[2] == v;
}

/* A new vertex within a triangle. */
static void split_triangle(uint32_t t) {
    uint32_t v[3], middle = s.vertex_count++;
    memcpy(v, s.triangles[t], sizeof v);
    s.triangles[t][2] = middle;
    add_triangle(v[1], v[2], middle);
    add_triangle(v[2], v[0], middle);
}

static uint32_t triangles_with(uint32_t a, uint32_t b, uint32_t except) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < s.triangle_count; t++)
        count += t != except && has_corner(s.triangles[t], a) && has_corner(s.triangles[t], b);
    return count;
}

/* Replaces the edge between two triangles by the one between their other corners, unless there is one already. */
static void flip_edge(uint32_t t, int k) {
    uint32_t a = s.triangles[t][k], b = s.triangles[t][(k + 1) % 3], p = s.triangles[t][(k + 2) % 3];
    if (triangles_with(a, b, t) != 1) return;
    for (uint32_t u = 0; u < s.triangle_count; u++) {
        if (u == t || !has_corner(s.triangles[u], a) || !has_corner(s.triangles[u], b)) continue;
        uint32_t q = s.triangles[u][0] ^ s.triangles[u][1] ^ s.triangles[u][2] ^ a ^ b;
        if (p == q || triangles_with(p, q, UINT32_MAX) > 0) return;
        const uint32_t one[3] = {a, q, p}, other[3] = {q, b, p};
        memcpy(s.triangles[t], one, sizeof one);
        memcpy(s.triangles[u], other, sizeof other);
        return;
    }
}

static void make_surface(uint64_t seed) {
    random_stream random = stream_start(seed);
    if (seed % 16 == 1)
        make_least(seed % 32 == 1);
    else if (seed % 3 == 0)
        make_torus(3 + stream_below(&random, 3), 3 + stream_below(&random, 3));
    else
        make_bipyramid(3 + stream_below(&random, 8));
    for (uint32_t i = stream_below(&random, 12); i > 0 && s.triangle_count + 2 < TRIANGLES_MAX; i--)
        split_triangle(stream_below(&random, s.triangle_count));
    for (uint32_t i = stream_below(&random, 40); i > 0; i--)
        flip_edge(stream_below(&random, s.triangle_count), (int)stream_below(&random, 3));
    for (uint32_t i = seed % 4 == 3 ? 1 + stream_below(&random, 3) : 0; i > 0; i--) { /* holes */
        uint32_t last = --s.triangle_count;
        memmove(s.triangles[stream_below(&random, last)], s.triangles[last], sizeof s.triangles[0]);
    }
    for (uint32_t i = seed % 8 == 5 ? 1 + stream_below(&random, 3) : 0; i > 0;
         i--) { /* edges of three triangles */
        const uint32_t *t = s.triangles[stream_below(&random, s.triangle_count)];
        uint32_t apex = stream_below(&random, s.vertex_count);
        if (!has_corner(t, apex)) add_triangle(t[0], t[1], apex);
    }
}

/* ---- the definition -------------------------------------------------------------------------------------- */

static bool all_adjacent(const cscd_mesh *mesh, const uint32_t *a, uint32_t a_count, const uint32_t *b,
                         uint32_t b_count) {
    for (uint32_t i = 0; i < a_count * b_count; i++) {
        if (!triangles_share_vertex(mesh->triangles[a[i / b_count]], mesh->triangles[b[i % b_count]]))
            return false;
    }
    return true;
}

static bool is_orphan_vf(const cscd_mesh *mesh, uint32_t v, uint32_t t) {
    uint32_t begin = mesh->vertex_star_offsets[v], count = mesh->vertex_star_offsets[v + 1] - begin;
    return count > 0 && !triangle_contains(mesh->triangles[t], v) &&
           all_adjacent(mesh, mesh->vertex_stars + begin, count, &t, 1);
}

static bool is_orphan_ee(const cscd_mesh *mesh, uint32_t a, uint32_t b) {
    const uint32_t *from = mesh->edge_star_offsets;
    return !edges_share_vertex(mesh->edges[a], mesh->edges[b]) &&
           all_adjacent(mesh, mesh->edge_stars + from[a], from[a + 1] - from[a], mesh->edge_stars + from[b],
                        from[b + 1] - from[b]);
}

/* Returns how often a pair is in a list. */
static size_t count_in(uint32_t (*pairs)[2], size_t count, uint32_t a, uint32_t b) {
    size_t found = 0;
    for (size_t i = 0; i < count; i++) found += pairs[i][0] == a && pairs[i][1] == b;
    return found;
}

static void check_pairs(const cscd_mesh *mesh, size_t sum[2]) {
    orphan_pairs found;
    bool too_many;
    size_t vf = 0, ee = 0;
    assert_int_equal(orphan_pairs_create(mesh, &found, &too_many), CSCD_OK);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (uint32_t t = 0; t < mesh->triangle_count; t++) vf += is_orphan_vf(mesh, v, t);
    }
    for (uint32_t a = 0; a < mesh->edge_count; a++) {
        for (uint32_t b = a + 1; b < mesh->edge_count; b++) ee += is_orphan_ee(mesh, a, b);
    }
    assert_int_equal(too_many, vf + ee > 8 * (size_t)mesh->triangle_count);
    if (too_many) return;
    assert_int_equal(found.vf_count, vf);
    assert_int_equal(found.ee_count, ee);
    for (size_t i = 0; i < vf; i++) {
        assert_true(is_orphan_vf(mesh, found.vf[i][0], found.vf[i][1]));
        assert_int_equal(count_in(found.vf, vf, found.vf[i][0], found.vf[i][1]), 1);
    }
    for (size_t i = 0; i < ee; i++) {
        assert_true(found.ee[i][0] < found.ee[i][1] && is_orphan_ee(mesh, found.ee[i][0], found.ee[i][1]));
        assert_int_equal(count_in(found.ee, ee, found.ee[i][0], found.ee[i][1]), 1);
    }
    sum[0] += vf;
    sum[1] += ee;
    orphan_pairs_free(mesh->context, &found);
}

TEST(pairs_are_those_of_the_definition) {
    size_t sum[2] = {0, 0};
    cscd_context *context = NULL;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    for (uint64_t seed = 0; seed < SURFACES; seed++) {
        cscd_mesh *mesh = NULL;
        make_surface(seed);
        const cscd_object_desc desc =
            cscd_object_of_triangles(s.vertex_count, s.triangle_count, &s.triangles[0][0]);
        assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
        check_pairs(mesh, sum);
        cscd_mesh_destroy(mesh);
    }
    cscd_context_destroy(context);
    print_message("  %zu pairs of a vertex and a triangle, %zu of two edges\n", sum[0], sum[1]);
    assert_true(sum[0] > 1000 && sum[1] > 1000);
}

/* ---- large meshes --------------------------------------------------------------------------------------- */

enum { LARGE_MAX = 100000, PAIRS_MAX = 8 * LARGE_MAX };

/* Surfaces side by side, and the pairs of each, found in it alone, in their numbers here. */
static struct {
    uint32_t triangles[LARGE_MAX][3], triangle_count, vertex_count, edge_count;
    uint32_t vf[PAIRS_MAX][2], ee[PAIRS_MAX][2];
    size_t vf_count, ee_count;
} large;

static void add_surface(const cscd_mesh *mesh, const orphan_pairs *pairs) {
    for (size_t i = 0; i < pairs->vf_count; i++) {
        large.vf[large.vf_count][0] = pairs->vf[i][0] + large.vertex_count;
        large.vf[large.vf_count++][1] = pairs->vf[i][1] + large.triangle_count;
    }
    for (size_t i = 0; i < pairs->ee_count; i++) {
        large.ee[large.ee_count][0] = pairs->ee[i][0] + large.edge_count;
        large.ee[large.ee_count++][1] = pairs->ee[i][1] + large.edge_count;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++)
            large.triangles[large.triangle_count][i] = mesh->triangles[t][i] + large.vertex_count;
        large.triangle_count++;
    }
    large.vertex_count += mesh->vertex_count;
    large.edge_count += mesh->edge_count;
}

static void make_large(cscd_context *context) {
    for (uint64_t seed = 0; large.triangle_count + TRIANGLES_MAX <= LARGE_MAX; seed++) {
        cscd_mesh *mesh = NULL;
        orphan_pairs pairs;
        bool too_many;
        make_surface(seed % SURFACES);
        const cscd_object_desc desc =
            cscd_object_of_triangles(s.vertex_count, s.triangle_count, &s.triangles[0][0]);
        assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
        assert_int_equal(orphan_pairs_create(mesh, &pairs, &too_many), CSCD_OK);
        if (!too_many) add_surface(mesh, &pairs);
        if (!too_many) orphan_pairs_free(mesh->context, &pairs);
        cscd_mesh_destroy(mesh);
    }
}

static cscd_context *context_of_threads(uint32_t count) {
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = count;
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    return context;
}

/* Tasks of several thousand triangles find what the surfaces have, in the same order, whoever does them. */
TEST(tasks_find_all_pairs) {
    for (uint32_t threads = 1; threads <= 3; threads++) {
        cscd_context *context = context_of_threads(threads);
        cscd_mesh *mesh = NULL;
        orphan_pairs pairs;
        bool too_many;
        if (threads == 1) make_large(context);
        const cscd_object_desc desc =
            cscd_object_of_triangles(large.vertex_count, large.triangle_count, &large.triangles[0][0]);
        assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
        assert_int_equal(orphan_pairs_create(mesh, &pairs, &too_many), CSCD_OK);
        assert_false(too_many);
        assert_int_equal(pairs.vf_count, large.vf_count);
        assert_int_equal(pairs.ee_count, large.ee_count);
        assert_memory_equal(pairs.vf, large.vf, large.vf_count * sizeof *large.vf);
        assert_memory_equal(pairs.ee, large.ee, large.ee_count * sizeof *large.ee);
        orphan_pairs_free(mesh->context, &pairs);
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(context);
    }
    print_message("  %u triangles, %zu and %zu pairs\n", large.triangle_count, large.vf_count,
                  large.ee_count);
    assert_true(large.vf_count > 1000 && large.ee_count > 1000);
}

/* All triangles of a fan are adjacent: no task finds more than all may have, but all tasks together do. */
TEST(too_many_in_all_tasks) {
    for (uint32_t threads = 1; threads <= 3; threads++) {
        cscd_context *context = context_of_threads(threads);
        cscd_mesh *mesh = NULL;
        orphan_pairs pairs;
        bool too_many;
        for (uint32_t t = 0; t < LARGE_MAX; t++) {
            const uint32_t tip = t / 30 * 32, corners[3] = {tip, tip + 1 + t % 30, tip + 2 + t % 30};
            memcpy(large.triangles[t], corners, sizeof corners);
        }
        const cscd_object_desc desc =
            cscd_object_of_triangles(LARGE_MAX / 30 * 32 + 32, LARGE_MAX, &large.triangles[0][0]);
        assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
        assert_int_equal(orphan_pairs_create(mesh, &pairs, &too_many), CSCD_OK);
        assert_true(too_many && pairs.vf == NULL && pairs.ee == NULL);
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(context);
    }
}

/* Workers that are suspended after each pair go on with the next: between them they test each orphan pair once. */
TEST(suspended_workers_leave_none_out) {
    enum { SHARES = 3 };
    static contact_worker worker;
    static const double at_rest[VERTICES_MAX * 3];
    const feature_list *vf = &worker.queue[CSCD_CONTACT_VF], *ee = &worker.queue[CSCD_CONTACT_EE];
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    orphan_pairs pairs;
    bool too_many;
    size_t queued[2] = {0, 0};
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    make_bipyramid(3);
    const cscd_object_desc desc =
        cscd_object_of_triangles(s.vertex_count, s.triangle_count, &s.triangles[0][0]);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(orphan_pairs_create(mesh, &pairs, &too_many), CSCD_OK);
    const swept_interval interval = {.mesh = mesh, .x0 = at_rest, .x1 = at_rest, .filter = {.mesh = mesh}};
    for (uint32_t i = 0; i < SHARES; i++) {
        contact_worker_reset(&worker);
        for (worker.limit = 0; i + worker.cursor * SHARES < pairs.vf_count + pairs.ee_count;)
            narrow_phase_test_orphan_pairs(&interval, &pairs, i, SHARES, &worker);
        for (uint32_t k = 0; k < vf->count; k++)
            queued[0] += count_in(pairs.vf, pairs.vf_count, vf->a[k], vf->b[k]);
        for (uint32_t k = 0; k < ee->count; k++)
            queued[1] += count_in(pairs.ee, pairs.ee_count, ee->a[k], ee->b[k]);
    }
    assert_true(pairs.vf_count == 12 && pairs.ee_count == 12);
    assert_true(queued[0] == 12 && queued[1] == 12);
    orphan_pairs_free(context, &pairs);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* Two tips over a ring have few orphan pairs, but looking for them takes the square of the ring's size: it is given up. */
TEST(looks_are_limited) {
    enum { RINGS = 2 };
    static const uint32_t rings[RINGS] = {96, 1 << 12};
    static uint32_t triangles[1 << 13][3];
    cscd_context *context = NULL;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    for (int i = 0; i < RINGS; i++) {
        const uint32_t ring = rings[i];
        cscd_mesh *mesh = NULL;
        orphan_pairs pairs;
        bool too_many = false;
        for (uint32_t t = 0; t < 2 * ring; t++) {
            const uint32_t a = t / 2, b = (a + 1) % ring;
            triangles[t][0] = ring + t % 2;
            triangles[t][1] = t % 2 == 0 ? a : b;
            triangles[t][2] = t % 2 == 0 ? b : a;
        }
        const cscd_object_desc desc = cscd_object_of_triangles(ring + 2, 2 * ring, triangles[0]);
        assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
        assert_int_equal(orphan_pairs_create(mesh, &pairs, &too_many), CSCD_OK);
        assert_int_equal(too_many, i == 1);
        orphan_pairs_free(context, &pairs);
        cscd_mesh_destroy(mesh);
    }
    cscd_context_destroy(context);
}
