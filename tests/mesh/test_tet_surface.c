/* Surfaces of tetrahedra: against brute force over all pairs of faces, the volume that they enclose, and bad input. */
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { CELLS = 4, POINTS = (CELLS + 1) * (CELLS + 1) * (CELLS + 1), TETS_MAX = 6 * CELLS * CELLS * CELLS };

static uint32_t tets[TETS_MAX][4];
static uint32_t count;
static double x[POINTS][3];
static cscd_context *context;

static int begin_test(void **state) {
    (void)state;
    return cscd_context_create(NULL, &context) == CSCD_OK ? 0 : 1;
}

static int end_test(void **state) {
    (void)state;
    cscd_context_destroy(context);
    return 0;
}

static double six_volumes(const double *a, const double *b, const double *c, const double *d) {
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
        w[k] = d[k] - a[k];
    }
    return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
           (u[0] * v[1] - u[1] * v[0]) * w[2];
}

static uint32_t point_at(uint32_t i, uint32_t j, uint32_t k) {
    return (i * (CELLS + 1) + j) * (CELLS + 1) + k;
}

/* A block of cubes of six tetrahedra each (Kuhn), of which a share is kept, in any order and turn of their vertices. */
static void make_block(double share, random_stream *random) {
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    count = 0;
    for (uint32_t p = 0; p < POINTS; p++) {
        x[p][0] = p / ((CELLS + 1) * (CELLS + 1)) + stream_between(random, -0.1, 0.1);
        x[p][1] = p / (CELLS + 1) % (CELLS + 1) + stream_between(random, -0.1, 0.1);
        x[p][2] = p % (CELLS + 1) + stream_between(random, -0.1, 0.1);
    }
    for (uint32_t cell = 0; cell < CELLS * CELLS * CELLS; cell++) {
        for (int t = 0; t < 6; t++) {
            uint32_t at[3] = {cell / (CELLS * CELLS), cell / CELLS % CELLS, cell % CELLS}, v[4];
            if (stream_between(random, 0.0, 1.0) > share) continue;
            v[0] = point_at(at[0], at[1], at[2]);
            for (int i = 0; i < 3; i++) {
                at[orders[t][i]]++;
                v[i + 1] = point_at(at[0], at[1], at[2]);
            }
            const uint32_t turn = stream_below(random, 3);
            const uint32_t turned[4] = {v[turn], v[(turn + 1) % 3], v[(turn + 2) % 3], v[3]};
            memcpy(tets[count], turned, sizeof turned);
            if (six_volumes(x[turned[0]], x[turned[1]], x[turned[2]], x[turned[3]]) < 0.0) {
                tets[count][0] = turned[1];
                tets[count][1] = turned[0];
            }
            count++;
        }
    }
    for (uint32_t i = count; i > 1; i--) {
        const uint32_t other = stream_below(random, i);
        uint32_t kept[4];
        memcpy(kept, tets[i - 1], sizeof kept);
        memcpy(tets[i - 1], tets[other], sizeof kept);
        memcpy(tets[other], kept, sizeof kept);
    }
}

static bool has_vertices(const uint32_t tet[4], const uint32_t face[3]) {
    int found = 0;
    for (int i = 0; i < 4; i++) found += tet[i] == face[0] || tet[i] == face[1] || tet[i] == face[2];
    return found == 3;
}

static uint32_t tets_with(const uint32_t face[3]) {
    uint32_t found = 0;
    for (uint32_t t = 0; t < count; t++) found += has_vertices(tets[t], face);
    return found;
}

static void check_triangles(const cscd_tet_surface_arrays *s) {
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        uint32_t face[3], last = 0;
        const uint32_t *tet = tets[s->tetrahedra[t]];
        for (uint32_t i = 0; i < 3; i++) {
            assert_true(s->triangles[3 * t + i] < s->vertex_count);
            face[i] = s->vertices[s->triangles[3 * t + i]];
        }
        assert_true(t == 0 || s->tetrahedra[t - 1] <= s->tetrahedra[t]);
        assert_true(has_vertices(tet, face));
        assert_int_equal(tets_with(face), 1);
        for (int i = 0; i < 4; i++)
            if (tet[i] != face[0] && tet[i] != face[1] && tet[i] != face[2]) last = tet[i];
        assert_true(six_volumes(x[face[0]], x[face[1]], x[face[2]], x[last]) < 0.0); /* it is behind */
    }
}

static void check_counts(const cscd_tet_surface_arrays *s) {
    static const int faces[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
    bool used[POINTS] = {false};
    uint32_t outer = 0, points = 0;
    for (uint32_t t = 0; t < count; t++) {
        for (int i = 0; i < 4; i++) {
            const uint32_t face[3] = {tets[t][faces[i][0]], tets[t][faces[i][1]], tets[t][faces[i][2]]};
            if (tets_with(face) > 1) continue;
            outer++;
            for (int k = 0; k < 3; k++) used[face[k]] = true;
        }
    }
    assert_int_equal(s->triangle_count, outer);
    for (uint32_t p = 0; p < POINTS; p++)
        if (used[p]) assert_true(points < s->vertex_count && s->vertices[points++] == p);
    assert_int_equal(s->vertex_count, points);
}

static void check_volume(const cscd_tet_surface_arrays *s) {
    static const double origin[3] = {0, 0, 0};
    double inside = 0.0, enclosed = 0.0;
    for (uint32_t t = 0; t < count; t++)
        inside += six_volumes(x[tets[t][0]], x[tets[t][1]], x[tets[t][2]], x[tets[t][3]]);
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t *v = s->triangles + (size_t)3 * t;
        enclosed += six_volumes(origin, x[s->vertices[v[0]]], x[s->vertices[v[1]]], x[s->vertices[v[2]]]);
    }
    assert_true(fabs(inside - enclosed) <= 1e-9);
}

TEST(surfaces_are_those_of_brute_force) {
    random_stream random = stream_start(1);
    const double shares[] = {1.0, 0.7, 0.3, 0.05};
    for (int i = 0; i < 4; i++) {
        cscd_tet_surface *surface;
        make_block(shares[i], &random);
        expect_ok(cscd_tet_surface_create(context, tets[0], count, POINTS, &surface));
        const cscd_tet_surface_arrays s = cscd_tet_surface_get(surface);
        check_triangles(&s);
        check_counts(&s);
        check_volume(&s);
        cscd_tet_surface_destroy(surface);
    }
}

/* A whole block is a closed manifold, of which a mesh can be made. */
TEST(a_surface_is_a_mesh) {
    random_stream random = stream_start(2);
    cscd_tet_surface *surface;
    cscd_mesh *mesh;
    make_block(1.0, &random);
    expect_ok(cscd_tet_surface_create(context, tets[0], count, POINTS, &surface));
    const cscd_tet_surface_arrays s = cscd_tet_surface_get(surface);
    assert_int_equal(s.triangle_count, 6 * CELLS * CELLS * 2);
    assert_int_equal(s.vertex_count, POINTS - (CELLS - 1) * (CELLS - 1) * (CELLS - 1));
    const cscd_object_desc object = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    expect_ok(cscd_mesh_create(context, &object, 1, &mesh));
    assert_true(cscd_mesh_component(mesh, 0).closed_manifold);
    cscd_mesh_destroy(mesh);
    cscd_tet_surface_destroy(surface);
    cscd_tet_surface_destroy(NULL);
}

/* ---- bad input ----------------------------------------------------------------------------------------- */

static void expect_refusal(const uint32_t (*given)[4], size_t given_count, uint32_t vertex_count,
                           const char *words) {
    cscd_tet_surface *surface = (cscd_tet_surface *)&surface;
    assert_int_equal(cscd_tet_surface_create(context, given[0], given_count, vertex_count, &surface),
                     CSCD_INVALID_MESH);
    if (strstr(cscd_context_detail(context), words) == NULL)
        fail_msg("\"%s\" does not say \"%s\"", cscd_context_detail(context), words);
    assert_ptr_equal(surface, (cscd_tet_surface *)&surface);
}

TEST(bad_tetrahedra_are_named) {
    const uint32_t large[2][4] = {{0, 1, 2, 3}, {1, 2, 3, 5}}, twice[1][4] = {{4, 1, 2, 4}},
                   three[3][4] = {{0, 1, 2, 3}, {0, 2, 1, 4}, {1, 0, 2, 5}},
                   side[2][4] = {{0, 1, 2, 3}, {0, 1, 2, 4}}, same[2][4] = {{0, 1, 2, 3}, {0, 1, 2, 3}};
    expect_refusal(large, 2, 5, "tetrahedron 1 has the vertex 5, but there are only 5");
    expect_refusal(twice, 1, 5, "tetrahedron 0 has the vertex 4 twice");
    expect_refusal(three, 3, 6, "tetrahedra 0, 1 and 2 have the face");
    expect_refusal(side, 2, 5, "tetrahedra 0 and 1 lie on one side");
    expect_refusal(same, 2, 5, "tetrahedra 0 and 1 lie on one side");
}

TEST(bad_calls) {
    const uint32_t one[4] = {0, 1, 2, 3};
    cscd_tet_surface *surface = NULL;
    assert_int_equal(cscd_tet_surface_create(NULL, one, 1, 4, &surface), CSCD_NULL_OBJECT);
    expect_invalid(context, cscd_tet_surface_create(context, NULL, 1, 4, &surface), "tetrahedra is NULL");
    expect_invalid(context, cscd_tet_surface_create(context, one, 1, 4, NULL), "out is NULL");
    expect_invalid(context, cscd_tet_surface_create(context, one, 0, 4, &surface), "tetrahedron_count is 0");
    expect_invalid(context, cscd_tet_surface_create(context, one, (size_t)1 << 30, 4, &surface),
                   "tetrahedron_count is 1073741824");
    assert_null(surface);
}

AROUND_EACH(begin_test, end_test)
