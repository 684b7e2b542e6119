/* Scenes of several objects: numbering, obstacles that have contacts only with other objects, positions in
 * any layout. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "src/mesh/positions.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 3, SCENES = 24, OBJECT_TRIANGLES_MAX = 700 };

/* Closed, open and worse objects, all in one place so that they have contacts. */
static const scene_family families[] = {SCENE_NOISY_SPHERE, SCENE_TWO_SPHERES, SCENE_FOLDED_SHEET,
                                        SCENE_BENT_CAPSULE, SCENE_SOUP,        SCENE_GRID,
                                        SCENE_SPIKE,        SCENE_BOW_TIE};

static scene objects[OBJECTS], joined; /* large; one test at a time */

static void make_objects(uint64_t seed) {
    random_stream random = stream_start(seed);
    scene_clear(&joined);
    for (int i = 0; i < OBJECTS; i++) {
        scene *s = &objects[i];
        do {
            uint32_t family = stream_below(&random, sizeof families / sizeof *families);
            scene_make(families[family], stream_bits(&random), s);
        } while (s->triangle_count > OBJECT_TRIANGLES_MAX ||
                 joined.vertex_count + s->vertex_count > SCENE_VERTICES_MAX ||
                 joined.triangle_count + s->triangle_count > SCENE_TRIANGLES_MAX);
        double shift = stream_between(&random, -0.5, 0.5);
        for (uint32_t v = 0; v < s->vertex_count * 3; v++) s->x1[v] += shift;
        memcpy(joined.x0 + joined.vertex_count * 3, s->x0, s->vertex_count * sizeof(double[3]));
        memcpy(joined.x1 + joined.vertex_count * 3, s->x1, s->vertex_count * sizeof(double[3]));
        for (uint32_t k = 0; k < s->triangle_count * 3; k++)
            joined.triangles[joined.triangle_count * 3 + k] = joined.vertex_count + s->triangles[k];
        joined.vertex_count += s->vertex_count;
        joined.triangle_count += s->triangle_count;
    }
}

typedef struct object_setting {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} object_setting;

/* obstacles has a bit for each object. */
static object_setting set_up(unsigned obstacles, cscd_method method, uint32_t thread_count) {
    object_setting s;
    cscd_object_desc descs[OBJECTS];
    for (int i = 0; i < OBJECTS; i++) {
        descs[i] = cscd_object_of_triangles(objects[i].vertex_count, objects[i].triangle_count,
                                            objects[i].triangles);
        descs[i].obstacle = obstacles >> i & 1;
    }
    cscd_context_options context_options = cscd_context_defaults();
    cscd_detector_options options = cscd_detector_defaults();
    context_options.thread_count = thread_count;
    options.method = method;
    assert_int_equal(cscd_context_create(&context_options, &s.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(s.context, descs, OBJECTS, &s.mesh), CSCD_OK);
    assert_int_equal(detector_create_here(s.mesh, NULL, &options, &s.detector), CSCD_OK);
    return s;
}

static void tear_down(object_setting *s) {
    cscd_detector_destroy(s->detector);
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
}

/* ---- numbering ----------------------------------------------------------------------------------------- */

TEST(features_follow_each_other) {
    make_objects(1);
    object_setting s = set_up(2, CSCD_METHOD_NONE, 1);
    uint32_t vertices = 0, edges = 0, triangles = 0;
    assert_int_equal(cscd_mesh_object_count(s.mesh), OBJECTS);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        cscd_object o = cscd_mesh_object(s.mesh, i);
        assert_true(o.first_vertex == vertices && o.first_edge == edges && o.first_triangle == triangles);
        assert_true(o.vertex_count == objects[i].vertex_count && o.obstacle == (i == 1));
        assert_int_equal(o.triangle_count, objects[i].triangle_count);
        for (uint32_t v = 0; v < o.vertex_count; v++)
            assert_int_equal(cscd_mesh_vertex_object(s.mesh, o.first_vertex + v), i);
        for (uint32_t e = 0; e < o.edge_count; e++) {
            uint32_t ends[2];
            cscd_mesh_edge(s.mesh, o.first_edge + e, ends);
            assert_true(ends[0] >= o.first_vertex && ends[1] < o.first_vertex + o.vertex_count);
        }
        for (uint32_t t = 0; t < o.triangle_count; t++) {
            uint32_t corners[3];
            cscd_mesh_triangle(s.mesh, o.first_triangle + t, corners);
            for (int k = 0; k < 3; k++)
                assert_int_equal(corners[k] - o.first_vertex, objects[i].triangles[t * 3 + (uint32_t)k]);
        }
        vertices += o.vertex_count;
        edges += o.edge_count;
        triangles += o.triangle_count;
    }
    assert_int_equal(edges, cscd_mesh_edge_count(s.mesh));
    assert_int_equal(vertices, cscd_mesh_vertex_count(s.mesh));
    tear_down(&s);
}

TEST(a_mesh_is_one_object) {
    cscd_context *context;
    cscd_mesh *mesh;
    const uint32_t triangles[] = {0, 1, 2};
    const cscd_object_desc desc = cscd_object_of_triangles(4, 1, triangles);
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    cscd_object o = cscd_mesh_object(mesh, 0);
    assert_int_equal(cscd_mesh_object_count(mesh), 1);
    assert_true(o.vertex_count == 4 && o.edge_count == 3 && o.triangle_count == 1 && !o.obstacle);
    assert_int_equal(cscd_mesh_vertex_object(mesh, 3), 0);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

TEST(mistakes_name_the_object) {
    cscd_context *context;
    cscd_mesh *mesh = NULL;
    const uint32_t good[] = {0, 1, 2}, outside[] = {0, 1, 3}, repeated[] = {2, 1, 2};
    cscd_object_desc o[2] = {cscd_object_of_triangles(3, 1, good), cscd_object_of_triangles(3, 1, outside)};
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, o, 2, &mesh), CSCD_INVALID_MESH);
    assert_string_equal(cscd_context_detail(context),
                        "object 1: triangle 0 names vertex 3, but there are 3 vertices");
    o[1].triangles = repeated;
    assert_int_equal(cscd_mesh_create(context, o, 2, &mesh), CSCD_INVALID_MESH);
    assert_non_null(strstr(cscd_context_detail(context), "object 1: triangle 0 (2 1 2) repeats a vertex"));
    o[1] = cscd_object_of_triangles(3, 0, good);
    assert_int_equal(cscd_mesh_create(context, o, 2, &mesh), CSCD_INVALID_MESH);
    assert_non_null(strstr(cscd_context_detail(context), "object 1: the mesh is empty"));
    o[1] = cscd_object_of_triangles(UINT32_MAX, 1, good);
    assert_int_equal(cscd_mesh_create(context, o, 2, &mesh), CSCD_INVALID_MESH);
    assert_non_null(strstr(cscd_context_detail(context), "too many"));
    assert_int_equal(cscd_mesh_create(context, o, 0, &mesh), CSCD_INVALID_MESH);
    assert_int_equal(cscd_mesh_create(context, NULL, 1, &mesh), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_mesh_create(NULL, o, 1, &mesh), CSCD_NULL_OBJECT);
    assert_null(mesh);
    cscd_context_destroy(context);
}

/* ---- obstacles ----------------------------------------------------------------------------------------- */

static bool of_obstacle(const cscd_mesh *mesh, unsigned obstacles, uint32_t vertex) {
    return (obstacles >> cscd_mesh_vertex_object(mesh, vertex) & 1) != 0;
}

static bool between_obstacles(const cscd_mesh *mesh, unsigned obstacles, const cscd_contact *c) {
    cscd_stencil s = cscd_mesh_stencil(mesh, c->kind, c->a, c->b, c->u, c->v);
    return of_obstacle(mesh, obstacles, s.vertices[0]) && of_obstacle(mesh, obstacles, s.vertices[3]);
}

static size_t compare_contacts(const object_setting *all, const object_setting *some, unsigned obstacles) {
    cscd_contacts truth, found;
    size_t next = 0;
    assert_int_equal(step_packed(all->detector, joined.x0, joined.x1, &truth), CSCD_OK);
    assert_int_equal(step_packed(some->detector, joined.x0, joined.x1, &found), CSCD_OK);
    for (size_t i = 0; i < truth.count; i++) {
        if (between_obstacles(all->mesh, obstacles, &truth.items[i])) continue;
        assert_true(next < found.count);
        assert_memory_equal(&found.items[next++], &truth.items[i], sizeof *truth.items);
    }
    assert_int_equal(next, found.count);
    return next;
}

static void compare_checks(const object_setting *all, const object_setting *some, unsigned obstacles) {
    cscd_intersections truth, found;
    size_t next = 0;
    assert_int_equal(check_packed(all->detector, joined.x0, &truth), CSCD_OK);
    assert_int_equal(check_packed(some->detector, joined.x0, &found), CSCD_OK);
    for (size_t i = 0; i < truth.count; i++) {
        uint32_t a[3], b[3];
        cscd_mesh_triangle(all->mesh, truth.items[i].a, a);
        cscd_mesh_triangle(all->mesh, truth.items[i].b, b);
        if (of_obstacle(all->mesh, obstacles, a[0]) && of_obstacle(all->mesh, obstacles, b[0])) continue;
        assert_true(next < found.count);
        assert_memory_equal(&found.items[next++], &truth.items[i], sizeof *truth.items);
    }
    assert_int_equal(next, found.count);
}

static void check_guarantees(const object_setting *s, unsigned obstacles) {
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(s->mesh); t++) {
        uint32_t corners[3];
        cscd_mesh_triangle(s->mesh, t, corners);
        cscd_guarantee g = cscd_detector_guarantee(s->detector, cscd_mesh_triangle_component(s->mesh, t));
        bool obstacle = of_obstacle(s->mesh, obstacles, corners[0]);
        assert_true((g.reason == CSCD_REASON_OBSTACLE) == obstacle && g.complete == !obstacle);
    }
}

/* The list equals the one without obstacles, minus the contacts between two of them. */
TEST(obstacles_meet_only_others) {
    static const cscd_method methods[] = {CSCD_METHOD_BRUTE, CSCD_METHOD_NONE, CSCD_METHOD_SINGLE,
                                          CSCD_METHOD_ICCD};
    size_t contacts = 0;
    for (unsigned seed = 0; seed < SCENES; seed++) {
        unsigned obstacles = seed % 8;
        make_objects(seed);
        object_setting all = set_up(0, CSCD_METHOD_BRUTE, 1);
        for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
            object_setting some = set_up(obstacles, method_or_none(methods[m]), 1 + (seed + (unsigned)m) % 3);
            compare_checks(&all, &some, obstacles);
            contacts += compare_contacts(&all, &some, obstacles);
            check_guarantees(&some, obstacles);
            tear_down(&some);
        }
        tear_down(&all);
    }
    print_message("  %zu contacts\n", contacts);
    assert_true(contacts > 1000);
}

/* Pairs within obstacles are skipped from the beginning: a scene of obstacles alone costs no test of
 * volumes. */
TEST(obstacles_cost_nothing) {
    make_objects(3);
    cscd_contacts found;
    object_setting s = set_up(7, CSCD_METHOD_NONE, 1);
    assert_int_equal(step_packed(s.detector, joined.x0, joined.x1, &found), CSCD_OK);
    cscd_counters counters = cscd_detector_counters(s.detector);
    assert_true(found.count == 0 && counters.boxes_tested == 0 && counters.pcp == 0);
    tear_down(&s);
}

/* A plan by charge neither charges nor divides an obstacle, and divides other objects as it does without
 * the obstacle. */
TEST(obstacles_are_not_planned) {
    for (int i = 0; i < OBJECTS; i++) scene_make(SCENE_BENT_CAPSULE, (uint64_t)i, &objects[i]);
    static double x[3 * SCENE_VERTICES_MAX * 3];
    uint32_t vertices = 0;
    for (int i = 0; i < OBJECTS; i++) {
        memcpy(x + vertices * 3, objects[i].x0, objects[i].vertex_count * sizeof(double[3]));
        vertices += objects[i].vertex_count;
    }
    object_setting s = set_up(2, CSCD_METHOD_NONE, 1), all = set_up(0, CSCD_METHOD_NONE, 1);
    cscd_plan *plan = NULL, *whole = NULL;
    assert_int_equal(plan_create_packed(s.mesh, x, NULL, &plan), CSCD_OK);
    assert_int_equal(plan_create_packed(all.mesh, x, NULL, &whole), CSCD_OK);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        cscd_object o = cscd_mesh_object(s.mesh, i);
        assert_true((cscd_plan_capacitance(plan, i) > 0.0) == !o.obstacle);
        for (uint32_t t = o.first_triangle; t < o.first_triangle + o.triangle_count; t++) {
            double charge = o.obstacle ? 0.0 : cscd_plan_triangle_charge(whole, t);
            assert_true(cscd_plan_triangle_charge(plan, t) == charge);
            assert_true(!o.obstacle || cscd_plan_triangle_region(plan, t) ==
                                           cscd_plan_triangle_region(plan, o.first_triangle));
        }
    }
    cscd_plan_destroy(plan);
    cscd_plan_destroy(whole);
    tear_down(&s);
    tear_down(&all);
    object_setting none = set_up(7, CSCD_METHOD_NONE, 1);
    assert_int_equal(plan_create_packed(none.mesh, x, NULL, &plan), CSCD_OK);
    assert_int_equal(cscd_plan_region_count(plan), OBJECTS);
    cscd_plan_destroy(plan);
    tear_down(&none);
}

/* ---- layouts ------------------------------------------------------------------------------------------- */

/* Positions come as rows of seven floats, unaligned, as columns of doubles, and as packed doubles. */
TEST(positions_come_in_any_layout) {
    make_objects(5);
    object_setting s = set_up(0, CSCD_METHOD_NONE, 1);
    static char floats[SCENE_VERTICES_MAX * 28 + 1];
    static double columns[3][SCENE_VERTICES_MAX];
    for (uint32_t v = 0; v < objects[0].vertex_count; v++) {
        for (uint32_t k = 0; k < 3; k++) {
            float x = (float)objects[0].x0[v * 3 + k];
            memcpy(floats + 1 + v * 28 + k * sizeof x, &x, sizeof x);
        }
    }
    for (uint32_t v = 0; v < objects[1].vertex_count; v++) {
        for (uint32_t k = 0; k < 3; k++) columns[k][v] = objects[1].x0[v * 3 + k];
    }
    const cscd_view views[OBJECTS] = {
        {floats + 1, sizeof floats - 1, 28, 0, CSCD_SCALAR_FLOAT, 1},
        {columns, sizeof columns, sizeof(double), sizeof *columns, CSCD_SCALAR_DOUBLE, 1},
        {objects[2].x0, objects[2].vertex_count * sizeof(double[3]), 0, 0, CSCD_SCALAR_DOUBLE, 1}};
    double *buffer = NULL;
    const double *packed = NULL;
    assert_int_equal(views_read(s.context, s.mesh, views, "x0", &buffer, &packed), CSCD_OK);
    for (uint32_t i = 0; i < joined.vertex_count * 3; i++) {
        bool rounded = i < objects[0].vertex_count * 3;
        assert_true(packed[i] == (rounded ? (double)(float)joined.x0[i] : joined.x0[i]));
    }
    context_free(s.context, buffer);
    tear_down(&s);
}

static void expect_refused(const object_setting *s, const cscd_view *views, const char *sentence) {
    cscd_intersections found;
    assert_int_equal(cscd_detector_check(s->detector, views, &found), CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(s->context), sentence));
}

TEST(bad_views_are_named) {
    make_objects(5);
    object_setting s = set_up(0, CSCD_METHOD_NONE, 1);
    cscd_view views[OBJECTS];
    for (int i = 0; i < OBJECTS; i++) {
        views[i] = cscd_view_doubles(objects[i].x0, objects[i].vertex_count);
        views[i].object_count = 1;
    }
    cscd_view last = views[OBJECTS - 1];
    cscd_intersections found;
    assert_int_equal(cscd_detector_check(s.detector, views, &found), CSCD_OK);
    views[2].data = NULL;
    expect_refused(&s, views, "positions[2].data is NULL");
    views[2] = last;
    views[2].scalar = (cscd_scalar)2;
    expect_refused(&s, views, "positions[2].scalar is 2");
    views[2] = last;
    views[2].size--;
    expect_refused(&s, views, "the array is too short");
    views[2].size++;
    views[2].object_count = 2;
    expect_refused(&s, views, "positions[2] is to hold 2 objects, but only 1");
    views[2].object_count = 0;
    views[0].object_count = 0; /* so it would hold the vertices of all objects */
    expect_refused(&s, views, "positions[0] has");
    expect_refused(&s, NULL, "positions is NULL");
    tear_down(&s);
}
