/* Scenes with loose objects beside the rest of the API: threads, instruction sets, starts in contact, floats and views,
 * memory; and triangles to which nothing has changed. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/loose/loose_scene.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static loose_scene scene;

static const loose_recipe everything = {
    .triangles = true, .wires = true, .points = true, .half_spaces = true, .motion = 0.5};

/* ---- the same bits ------------------------------------------------------------------------------------------ */

enum { LIST_MAX = 20000 };
/* ---- triangles are what they were --------------------------------------------------------------------------- */

/* A mesh of the triangles alone, whose vertices and edges are numbered as if the loose ones were missing. */
static cscd_mesh *triangles_alone(uint32_t *vertex_of, double *x0, double *x1) {
    cscd_object_desc descs[LOOSE_OBJECTS_MAX];
    cscd_mesh *mesh = NULL;
    uint32_t count = 0, vertices = 0;
    for (uint32_t i = 0; i < scene.object_count; i++) {
        cscd_object o = cscd_mesh_object(scene.mesh, i);
        if (o.kind != CSCD_OBJECT_TRIANGLES) continue;
        descs[count++] = scene.objects[i];
        for (uint32_t v = 0; v < o.vertex_count; v++) vertex_of[vertices++] = o.first_vertex + v;
    }
    for (size_t i = 0; i < (size_t)vertices * 3; i++) {
        x0[i] = scene.x0[vertex_of[i / 3] * 3 + i % 3];
        x1[i] = scene.x1[vertex_of[i / 3] * 3 + i % 3];
    }
    assert_int_equal(cscd_mesh_create(scene.context, descs, count, &mesh), CSCD_OK);
    return mesh;
}

static bool of_triangles(const cscd_contact *c) {
    for (int i = 0; i < 4; i++) {
        uint32_t object = cscd_mesh_vertex_object(scene.mesh, c->vertices[i]);
        if (scene.objects[object].kind != CSCD_OBJECT_TRIANGLES) return false;
    }
    return true;
}

TEST(triangles_unchanged) {
    size_t compared = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        random_stream random = stream_start(100 + seed);
        uint32_t vertex_of[LOOSE_VERTICES_MAX];
        double x0[LOOSE_VERTICES_MAX * 3], x1[LOOSE_VERTICES_MAX * 3];
        loose_scene_make(&scene, &everything, &random, 1, CSCD_SIMD_AUTO);
        cscd_detector_options options = cscd_detector_defaults();
        options.method = seed % 2 == 0 ? CSCD_METHOD_NONE : CSCD_METHOD_SINGLE;
        options.min_separation = seed % 3 == 2 ? 0.1 : 0.0;
        cscd_mesh *mesh = triangles_alone(vertex_of, x0, x1);
        cscd_detector *with = loose_scene_detector(&scene, &options), *without = NULL;
        cscd_contacts all, few;
        assert_int_equal(detector_create_here(mesh, NULL, &options, &without), CSCD_OK);
        assert_int_equal(step_packed(with, scene.x0, scene.x1, &all), CSCD_OK);
        assert_int_equal(step_packed(without, x0, x1, &few), CSCD_OK);
        size_t at = 0;
        for (size_t i = 0; i < all.count; i++) {
            if (!of_triangles(&all.items[i])) continue;
            const cscd_contact *a = &all.items[i], *b = &few.items[at++];
            assert_true(at <= few.count && a->kind == b->kind && a->toi == b->toi && a->u == b->u &&
                        a->v == b->v);
            for (int k = 0; k < 4; k++) assert_int_equal(a->vertices[k], vertex_of[b->vertices[k]]);
            compared++;
        }
        assert_int_equal(at, few.count);
        cscd_detector_destroy(with);
        cscd_detector_destroy(without);
        cscd_mesh_destroy(mesh);
        loose_scene_free(&scene);
    }
    assert_true(compared > 100);
}

/* ---- touching at the start --------------------------------------------------------------------------------- */

/* A vertex behind the plane, a point in a face and crossing wires are in contact, and say so. */
TEST(contact_at_the_start) {
    static const uint32_t triangle[3] = {0, 1, 2}, wire[2] = {0, 1};
    static const double up[3] = {0, 0, 2};
    double x[] = {0,  0,  0,   1, 0, 0,   0, 1, 0,  0.25, 0.25, 1, 0, 0,
                  -1, -1, 0.5, 2, 1, 0.5, 2, 0, -1, 3,    0,    1, 3};
    cscd_object_desc objects[5] = {cscd_object_of_triangles(3, 1, triangle), cscd_object_of_points(1),
                                   cscd_object_half_space(up), cscd_object_of_wires(2, 1, wire),
                                   cscd_object_of_wires(2, 1, wire)};
    static const char *const texts[3] = {"vertex 3 and triangle 0 touch",
                                         "vertex 3 and the half-space, object 2 touch",
                                         "edge 3 and edge 4 touch"};
    static const cscd_contact_kind kinds[3] = {CSCD_CONTACT_VF, CSCD_CONTACT_VH, CSCD_CONTACT_EE};
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, objects, 5, &mesh), CSCD_OK);
    assert_int_equal(detector_create_here(mesh, NULL, NULL, &detector), CSCD_OK);
    for (int i = 0; i < 3; i++) {
        double moved[27], end[27];
        cscd_free_step step;
        memcpy(moved, x, sizeof moved);
        if (i == 0) moved[3 * 3 + 2] = 0.0;  /* the point in the face */
        if (i == 1) moved[3 * 3 + 2] = -1.0; /* on the plane */
        if (i == 2) moved[7 * 3 + 2] = moved[8 * 3 + 2] = 2.0;
        assert_int_equal(max_step_packed(detector, moved, moved, end, &step), CSCD_IN_CONTACT);
        if (strstr(cscd_context_detail(context), texts[i]) == NULL)
            fail_msg("%s", cscd_context_detail(context));
        assert_int_equal(step.limit.kind, kinds[i]);
    }
    double end[27];
    cscd_free_step step;
    assert_int_equal(max_step_packed(detector, x, x, end, &step), CSCD_OK);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* ---- floats and views --------------------------------------------------------------------------------------- */

/* Positions as a float solver keeps them: a view for each object, floats in structs. What it stores is certified. */
TEST(marching_in_floats) {
    typedef struct particle {
        float mass, x[3];
    } particle;
    size_t moved = 0, steps = 0;
    for (uint64_t seed = 0; seed < 6; seed++) {
        random_stream random = stream_start(400 + seed);
        loose_recipe recipe = everything;
        recipe.thickness = true;
        loose_scene_make(&scene, &recipe, &random, 1, CSCD_SIMD_AUTO);
        cscd_detector_options options = loose_scene_options(&scene);
        cscd_detector *detector = loose_scene_detector(&scene, &options);
        particle now[LOOSE_VERTICES_MAX], next[LOOSE_VERTICES_MAX];
        cscd_view from[LOOSE_OBJECTS_MAX], to[LOOSE_OBJECTS_MAX];
        cscd_mutable_view reached[LOOSE_OBJECTS_MAX];
        for (uint32_t i = 0; i < scene.object_count; i++) {
            cscd_object o = cscd_mesh_object(scene.mesh, i);
            size_t size = o.vertex_count * sizeof(particle) - offsetof(particle, x);
            from[i] = (cscd_view){now[o.first_vertex].x, size, sizeof(particle), sizeof(float),
                                  CSCD_SCALAR_FLOAT,     1};
            to[i] = from[i];
            to[i].data = next[o.first_vertex].x;
            reached[i] = (cscd_mutable_view){next[o.first_vertex].x, size, sizeof(particle), sizeof(float),
                                             CSCD_SCALAR_FLOAT,      1};
        }
        for (uint32_t v = 0; v < scene.vertex_count; v++) {
            bool low = scene.objects[cscd_mesh_vertex_object(scene.mesh, v)].kind == CSCD_OBJECT_HALF_SPACE;
            for (size_t k = 0; k < 3; k++)
                now[v].x[k] = (float)(100.0 + scene.x0[v * 3 + k] - (low && k > 0 ? 3.0 : 0.0));
        }
        for (int i = 0; i < 60; i++) {
            cscd_free_step step;
            for (uint32_t v = 0; v < scene.vertex_count; v++) {
                for (size_t k = 0; k < 3; k++)
                    next[v].x[k] =
                        now[v].x[k] + (float)(stream_between(&random, -0.05, 0.05) +
                                              0.05 * (scene.x1[v * 3 + k] - scene.x0[v * 3 + k]) / 20.0);
            }
            cscd_status status = cscd_detector_max_step(detector, from, to, reached, &step);
            if (status != CSCD_OK) fail_msg("%s", cscd_context_detail(scene.context));
            moved += step.moved;
            steps++;
            memcpy(now, next, sizeof now);
        }
        cscd_detector_destroy(detector);
        loose_scene_free(&scene);
    }
    assert_true(moved > steps / 2);
}
