/* Meshes: edges, stars, components and what is wrong with them; bad input; memory. */
#include "src/mesh/mesh.h"
#include "tests/support/changing_mesh.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <string.h>

enum { NONE = -1 };

/* ---- every mesh ---- */

static uint32_t shared_by(const mesh_shape *s, const uint32_t edge[2], uint32_t triangle) {
    uint32_t found = 0;
    for (int i = 0; i < 3; i++)
        found += s->triangles[triangle][i] == edge[0] || s->triangles[triangle][i] == edge[1];
    return found;
}

static uint32_t has_vertex(const mesh_shape *s, uint32_t vertex, uint32_t triangle) {
    const uint32_t *v = s->triangles[triangle];
    return v[0] == vertex || v[1] == vertex || v[2] == vertex;
}

/* Edges are sorted and listed once each; a triangle's edge i joins its corners i and i + 1. */
static void check_edges(const cscd_mesh *mesh, const mesh_shape *s) {
    for (uint32_t e = 0; e < cscd_mesh_edge_count(mesh); e++) {
        uint32_t v[2], before[2];
        cscd_mesh_edge(mesh, e, v);
        assert_true(v[0] < v[1] && v[1] < s->vertex_count);
        if (e == 0) continue;
        cscd_mesh_edge(mesh, e - 1, before);
        assert_true(before[0] < v[0] || (before[0] == v[0] && before[1] < v[1]));
    }
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        uint32_t v[3], edges[3], edge[2];
        cscd_mesh_triangle(mesh, t, v);
        cscd_mesh_triangle_edges(mesh, t, edges);
        assert_memory_equal(v, s->triangles[t], sizeof v);
        for (int i = 0; i < 3; i++) {
            uint32_t a = v[i], b = v[(i + 1) % 3];
            cscd_mesh_edge(mesh, edges[i], edge);
            assert_true(edge[0] == (a < b ? a : b) && edge[1] == (a < b ? b : a));
        }
    }
}

/* Lists all triangles that contain the feature, in ascending order. */
static void check_stars(const cscd_mesh *mesh, const mesh_shape *s) {
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        uint32_t count, next = 0;
        const uint32_t *star = cscd_mesh_vertex_triangles(mesh, v, &count);
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            if (has_vertex(s, v, t)) assert_true(next < count && star[next++] == t);
        }
        assert_int_equal(next, count);
    }
    for (uint32_t e = 0; e < cscd_mesh_edge_count(mesh); e++) {
        uint32_t edge[2], count, next = 0;
        const uint32_t *star = cscd_mesh_edge_triangles(mesh, e, &count);
        cscd_mesh_edge(mesh, e, edge);
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            if (shared_by(s, edge, t) == 2) assert_true(next < count && star[next++] == t);
        }
        assert_true(next > 0 && next == count);
    }
}

static cscd_status create_mesh(cscd_context *context, const mesh_shape *s, cscd_mesh **out) {
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles[0]);
    return cscd_mesh_create(context, &desc, 1, out);
}

/* The expected component of a shape; examples of edges and vertices are named by their vertices. */
typedef struct expected_component {
    uint32_t vertices, edges, triangles;
    uint32_t open, non_manifold, bow_ties, inconsistent;
    int64_t euler;
    int first_open[2], first_non_manifold[2], first_inconsistent[2], first_bow_tie; /* NONE */
} expected_component;

static void check_example(const cscd_mesh *mesh, uint32_t edge, const int expected[2]) {
    if (edge == UINT32_MAX) {
        assert_int_equal(expected[0], NONE);
        return;
    }
    uint32_t v[2];
    cscd_mesh_edge(mesh, edge, v);
    assert_int_equal((int)v[0], expected[0]);
    assert_int_equal((int)v[1], expected[1]);
}

static void check_component(const cscd_mesh *mesh, uint32_t index, const expected_component *expected) {
    cscd_component c = cscd_mesh_component(mesh, index);
    assert_int_equal(c.vertex_count, expected->vertices);
    assert_int_equal(c.edge_count, expected->edges);
    assert_int_equal(c.triangle_count, expected->triangles);
    assert_int_equal(c.open_edges, expected->open);
    assert_int_equal(c.non_manifold_edges, expected->non_manifold);
    assert_int_equal(c.non_manifold_vertices, expected->bow_ties);
    assert_int_equal(c.inconsistent_edges, expected->inconsistent);
    assert_true(c.euler_characteristic == expected->euler);
    bool flaws = expected->open + expected->non_manifold + expected->bow_ties + expected->inconsistent > 0;
    assert_true(c.closed_manifold == !flaws);
    check_example(mesh, c.first_open_edge, expected->first_open);
    check_example(mesh, c.first_non_manifold_edge, expected->first_non_manifold);
    check_example(mesh, c.first_inconsistent_edge, expected->first_inconsistent);
    assert_true(c.first_non_manifold_vertex ==
                (expected->first_bow_tie == NONE ? UINT32_MAX : (uint32_t)expected->first_bow_tie));
}

static void check_shape(const mesh_shape *s, uint32_t component_count, const expected_component *expected) {
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    cscd_mesh *mesh = NULL;
    assert_int_equal(create_mesh(context, s, &mesh), CSCD_OK);
    assert_int_equal(cscd_mesh_vertex_count(mesh), s->vertex_count);
    assert_int_equal(cscd_mesh_triangle_count(mesh), s->triangle_count);
    check_edges(mesh, s);
    check_stars(mesh, s);
    assert_int_equal(cscd_mesh_component_count(mesh), component_count);
    for (uint32_t i = 0; i < component_count; i++) check_component(mesh, i, &expected[i]);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}

#define NO_EDGES                                                                                             \
    {NONE, NONE}, {NONE, NONE}, {                                                                            \
        NONE, NONE                                                                                           \
    }

/* ---- closed surfaces ---- */

TEST(closed_surfaces) {
    static const expected_component tetrahedron = {4, 6, 4, 0, 0, 0, 0, 2, NO_EDGES, NONE};
    static const expected_component cube = {8, 18, 12, 0, 0, 0, 0, 2, NO_EDGES, NONE};
    static const expected_component torus = {30, 90, 60, 0, 0, 0, 0, 0, NO_EDGES, NONE};
    static const expected_component cones = {102, 300, 200, 0, 0, 0, 0, 2, NO_EDGES, NONE};
    mesh_shape s = {0};
    shape_add_tetrahedron(&s, 0, 1, 2, 3);
    check_shape(&s, 1, &tetrahedron);
    s = (mesh_shape){0};
    shape_add_cube(&s);
    check_shape(&s, 1, &cube);
    s = (mesh_shape){0};
    shape_add_grid(&s, 5, 6, true, true);
    check_shape(&s, 1, &torus);
    s = (mesh_shape){0};
    for (uint32_t i = 0; i < 100; i++) { /* two cones over one rim, jumping around it; tips 0 and 101 */
        uint32_t a = 37 * i % 100, b = (a + 1) % 100;
        shape_add_triangle(&s, 0, 1 + a, 1 + b);
        shape_add_triangle(&s, 1 + b, 1 + a, 101);
    }
    check_shape(&s, 1, &cones);
}

TEST(isolated_vertices) {
    static const expected_component tetrahedron = {4, 6, 4, 0, 0, 0, 0, 2, NO_EDGES, NONE};
    mesh_shape s = {0};
    shape_add_tetrahedron(&s, 1, 2, 4, 5);
    s.vertex_count = 8;
    check_shape(&s, 1, &tetrahedron);
}

TEST(two_components) {
    static const expected_component expected[2] = {{4, 6, 4, 0, 0, 0, 0, 2, NO_EDGES, NONE},
                                                   {8, 18, 12, 0, 0, 0, 0, 2, NO_EDGES, NONE}};
    mesh_shape cube = {0}, s = {0};
    shape_add_cube(&cube);
    shape_add_tetrahedron(&s, 9, 11, 8, 10); /* numbered by the first triangle, not by vertices */
    for (uint32_t t = 0; t < cube.triangle_count; t++)
        shape_add_triangle(&s, cube.triangles[t][0], cube.triangles[t][1], cube.triangles[t][2]);
    check_shape(&s, 2, expected);

    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    cscd_mesh *mesh = NULL;
    memcpy(s.triangles[15], s.triangles[0],
           sizeof s.triangles[0]); /* the tetrahedron once more, at the end */
    assert_int_equal(create_mesh(context, &s, &mesh), CSCD_OK);
    for (uint32_t t = 0; t < s.triangle_count; t++)
        assert_int_equal(cscd_mesh_triangle_component(mesh, t), t < 4 || t == 15 ? 0 : 1);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* ---- flawed ones ---- */

TEST(open_surfaces) {
    static const expected_component triangle = {3,   3, 1, 3, 0, 0, 0, 1, {0, 1}, {NONE, NONE}, {NONE, NONE},
                                                NONE};
    static const expected_component sheet = {20, 43,     24,           14,           0,   0, 0,
                                             1,  {0, 1}, {NONE, NONE}, {NONE, NONE}, NONE};
    static const expected_component cylinder = {24, 60,     36,           12,           0,   0, 0,
                                                0,  {0, 1}, {NONE, NONE}, {NONE, NONE}, NONE};
    mesh_shape s = {0};
    shape_add_triangle(&s, 0, 1, 2);
    check_shape(&s, 1, &triangle);
    s = (mesh_shape){0};
    shape_add_grid(&s, 3, 4, false, false);
    check_shape(&s, 1, &sheet);
    s = (mesh_shape){0};
    shape_add_grid(&s, 3, 6, false, true);
    check_shape(&s, 1, &cylinder);
}

TEST(moebius_strip) {
    static const expected_component strip = {12, 24, 12, 12, 0, 0, 1, 0, {0, 2}, {NONE, NONE}, {0, 1}, NONE};
    mesh_shape s = {0};
    shape_add_moebius_strip(&s, 6);
    check_shape(&s, 1, &strip);
}

TEST(bow_ties) {
    static const expected_component tetrahedra = {7, 12, 8, 0, 0, 1, 0, 3, NO_EDGES, 3};
    static const expected_component triangles = {5, 6, 2, 6, 0, 1, 0, 1, {0, 1}, {NONE, NONE}, {NONE, NONE},
                                                 2};
    mesh_shape s = {0};
    shape_add_tetrahedron(&s, 0, 1, 2, 3);
    shape_add_tetrahedron(&s, 4, 3, 6, 5);
    check_shape(&s, 1, &tetrahedra);
    s = (mesh_shape){0};
    shape_add_triangle(&s, 0, 1, 2);
    shape_add_triangle(&s, 2, 3, 4);
    check_shape(&s, 1, &triangles);
}

TEST(three_on_an_edge) {
    static const expected_component fins = {5, 7, 3, 6, 1, 0, 0, 1, {0, 2}, {0, 1}, {NONE, NONE}, NONE};
    mesh_shape s = {0};
    shape_add_triangle(&s, 0, 1, 2);
    shape_add_triangle(&s, 1, 0, 3);
    shape_add_triangle(&s, 0, 1, 4);
    check_shape(&s, 1, &fins);
}

TEST(flipped_triangle) {
    static const expected_component flipped = {8, 18,           12,           0,      0,   0, 3,
                                               2, {NONE, NONE}, {NONE, NONE}, {0, 1}, NONE};
    mesh_shape s = {0};
    shape_add_cube(&s);
    uint32_t *v = s.triangles[1], second = v[1]; /* 0 3 1 */
    v[1] = v[2];
    v[2] = second;
    check_shape(&s, 1, &flipped);
}

/* The same triangle twice is a closed surface without volume; the other way round, an inconsistent one. */
TEST(doubled_triangle) {
    static const expected_component pillow = {3, 3, 2, 0, 0, 0, 0, 2, NO_EDGES, NONE};
    static const expected_component doubled = {3,      3,   2, 0, 0, 0, 3, 2, {NONE, NONE}, {NONE, NONE},
                                               {0, 1}, NONE};
    mesh_shape s = {0};
    shape_add_triangle(&s, 0, 1, 2);
    shape_add_triangle(&s, 2, 1, 0);
    check_shape(&s, 1, &pillow);
    memcpy(s.triangles[1], (uint32_t[]){1, 2, 0}, sizeof s.triangles[1]);
    check_shape(&s, 1, &doubled);
}

/* ---- bad input ---- */

static void check_refused(cscd_context *context, const cscd_object_desc *desc, cscd_status expected,
                          const char *detail) {
    size_t bytes = cscd_context_describe(context).bytes;
    cscd_mesh *const untouched = (cscd_mesh *)&bytes;
    cscd_mesh *mesh = untouched;
    assert_int_equal(cscd_mesh_create(context, desc, 1, &mesh), expected);
    assert_ptr_equal(mesh, untouched);
    assert_int_equal(cscd_context_describe(context).bytes, bytes);
    if (strstr(cscd_context_detail(context), detail) == NULL)
        fail_msg("no '%s' in '%s'", detail, cscd_context_detail(context));
}

TEST(refused_descriptions) {
    static const uint32_t good[] = {0, 1, 2, 0, 2, 3}, beyond[] = {0, 1, 2, 0, 2, 4};
    static const uint32_t last[] = {0, 1, 2, 3, 2, UINT32_MAX};
    static const uint32_t repeats[3][6] = {{0, 1, 2, 3, 3, 1}, {0, 1, 2, 3, 1, 3}, {0, 1, 2, 1, 3, 3}};
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    check_refused(context, &(cscd_object_desc){.vertex_count = 4, .triangle_count = 2, .triangles = beyond},
                  CSCD_INVALID_MESH, "triangle 1 ");
    check_refused(context, &(cscd_object_desc){.vertex_count = 4, .triangle_count = 2, .triangles = beyond},
                  CSCD_INVALID_MESH, "vertex 4");
    check_refused(context, &(cscd_object_desc){.vertex_count = 4, .triangle_count = 2, .triangles = last},
                  CSCD_INVALID_MESH, "triangle 1 ");
    for (int i = 0; i < 3; i++)
        check_refused(context,
                      &(cscd_object_desc){.vertex_count = 4, .triangle_count = 2, .triangles = repeats[i]},
                      CSCD_INVALID_MESH, "triangle 1 ");
    check_refused(context, &(cscd_object_desc){.vertex_count = 0, .triangle_count = 2, .triangles = good},
                  CSCD_INVALID_MESH, "empty");
    check_refused(context, &(cscd_object_desc){.vertex_count = 4, .triangle_count = 0, .triangles = good},
                  CSCD_INVALID_MESH, "empty");
    check_refused(context, &(cscd_object_desc){.vertex_count = 4, .triangle_count = 0, .triangles = NULL},
                  CSCD_INVALID_MESH, "empty");
    check_refused(context,
                  &(cscd_object_desc){.vertex_count = 4, .triangle_count = 0x80000000u, .triangles = good},
                  CSCD_INVALID_MESH, "too many");
    check_refused(context,
                  &(cscd_object_desc){.vertex_count = 4, .triangle_count = UINT32_MAX, .triangles = good},
                  CSCD_INVALID_MESH, "too many");
    check_refused(context, &(cscd_object_desc){.vertex_count = 4, .triangle_count = 2, .triangles = NULL},
                  CSCD_INVALID_ARGUMENT, "NULL");
    check_refused(context, NULL, CSCD_INVALID_ARGUMENT, "NULL");
    assert_int_equal(
        cscd_mesh_create(
            context, &(cscd_object_desc){.vertex_count = 4, .triangle_count = 2, .triangles = good}, 1, NULL),
        CSCD_INVALID_ARGUMENT);
    cscd_mesh *mesh = NULL;
    assert_int_equal(
        cscd_mesh_create(NULL, &(cscd_object_desc){.vertex_count = 4, .triangle_count = 2, .triangles = good},
                         1, &mesh),
        CSCD_NULL_OBJECT);
    assert_null(mesh);
    cscd_mesh_destroy(NULL);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}
